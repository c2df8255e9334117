// SPDX-License-Identifier: MIT
#include "dynamics/program/shared_object.hpp"

#include <dlfcn.h>

#include <fstream>

#include "dynamics/program/cache.hpp"
#include "dynamics/program/compiler.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

// The hash of the sources that write programs: a changed generator finds no entry of the old one's.
constexpr const char* kGenerator = MIXLOOP_GENERATOR_HASH;

std::string entry_key(const std::string& key, const Compiler& compiler) {
  Sha256 hash;
  const auto part = [&](const std::string& text) { hash.add(std::to_string(text.size()) + ":" + text); };
  part(kGenerator);
  part(key);
  part(compiler.identity);
  for (const std::string& flag : machine_code_flags()) part(flag);
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
  const std::filesystem::path text = workshop.path() / "program.cpp", built = workshop.path() / "program.so";
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

SharedObject SharedObject::cached(const std::string& key, const std::function<std::string()>& source,
                                  std::string& complaint) {
  SharedObject result;
  const auto compiler = find_compiler();
  if (!compiler) {
    complaint = "no C++ compiler (c++, g++, clang++, $CXX; on Debian: apt-get install g++)";
    return result;
  }
  const auto directory = cache_directory();
  if (!directory) {
    complaint = "no private cache directory ($MIXLOOP_CACHE)";
    return result;
  }
  const CacheEntry entry(*directory, entry_key(key, *compiler));
  if (!entry.is_sound()) {
    const std::string text = source();
    if (text.empty() || !build(entry, *directory, *compiler, text, complaint)) return result;
  }
  result.library_.reset(::dlopen(entry.path().c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!result) complaint = ::dlerror();
  return result;
}

}  // namespace mixloop
