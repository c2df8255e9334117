// SPDX-License-Identifier: MIT
#include "dynamics/program/shared_object.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <fstream>

#include "dynamics/program/cache.hpp"
#include "dynamics/program/compiler.hpp"
#include "dynamics/program/processor.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

// The hash of the sources that write programs: a changed generator finds no entry of the old one's.
constexpr const char* kGenerator = MIXLOOP_GENERATOR_HASH;

constexpr const char* kNoCompiler =
    "no C++ compiler (c++, g++, clang++, $CXX; on Debian: apt-get install g++)";

std::string entry_key(const std::string& key, const Compiler& compiler) {
  Sha256 hash;
  const auto part = [&](const std::string& text) { hash.add(std::to_string(text.size()) + ":" + text); };
  part(kGenerator);
  part(key);
  part(compiler.identity);
  for (const std::string& flag : compiler.flags) part(flag);
  part(processor_identity());
  return hash.hex();
}

bool build(const CacheEntry& entry, const std::filesystem::path& directory, const Compiler& compiler,
           const std::string& source, std::string& complaint) {
  const Workshop workshop(directory);
  if (!workshop) {
    complaint = "cannot write to " + directory.string();
    return false;
  }
  const std::filesystem::path text = workshop.path() / (std::string("program") + compiler.suffix),
                              built = workshop.path() / "program.so";
  std::ofstream file(text);
  file << source;
  file.close();
  if (file && build_shared_object(compiler, text, built, complaint) && entry.adopt(built)) return true;
  if (complaint.empty()) complaint = "cannot write to " + directory.string();
  return false;
}

}  // namespace

void SharedObject::Close::operator()(void* library) const { ::dlclose(library); }

void* SharedObject::symbol(const std::string& name) const { return ::dlsym(library_.get(), name.c_str()); }

std::string SharedObject::hindrance() {
  if (!find_compiler()) return kNoCompiler;
  std::string complaint;
  cache_directory(complaint);
  return complaint;
}

SharedObject SharedObject::cached(const std::string& key, const std::function<std::string()>& source,
                                  std::string& complaint) {
  if (const auto compiler = find_compiler()) return cached(key, source, *compiler, complaint);
  complaint = kNoCompiler;
  return {};
}

SharedObject SharedObject::cached(const std::string& key, const std::function<std::string()>& source,
                                  const Compiler& compiler, std::string& complaint) {
  SharedObject result;
  const auto directory = cache_directory(complaint);
  if (!directory) return result;
  const CacheEntry entry(*directory, entry_key(key, compiler));
  result.file_ = entry.sound();
  if (!result.file_) {
    const std::string text = source();
    if (text.empty() || !build(entry, *directory, compiler, text, complaint)) return result;
    result.file_ = entry.sound();
    if (!result.file_) complaint = "cannot read back " + entry.path().string();
    if (!result.file_) return result;
  }
  result.library_.reset(
      ::dlopen(fmt::format("/proc/self/fd/{}", result.file_.get()).c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!result) complaint = ::dlerror();
  return result;
}

}  // namespace mixloop
