// SPDX-License-Identifier: MIT
// Emitted C++ on another processor and by another compiler: the bits of this one's machine code, and those
// that are written down.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/program/compiler.hpp"
#include "dynamics/program/firmware.hpp"
#include "dynamics/program/trace.hpp"
#include "tests/support/command.hpp"
#include "tests/support/start_at_home.hpp"

namespace mixloop {
namespace {

namespace fs = std::filesystem;

constexpr std::array kTried{Purpose::forward_dynamics, Purpose::mass_times, Purpose::bias,
                            Purpose::end_effector};

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (double value : values) text += fmt::format("{:a}, ", value);
  return text.empty() ? "0" : text;
}

/// A program that prints a hash of all bits that the scene's programs give at seeded states about home. Of
/// what is no number only that.
std::string hashing_program(const std::shared_ptr<const Scene>& scene) {
  std::string text = firmware_source(scene, {kTried.begin(), kTried.end()}, Trigonometry::inlined);
  text += R"(
#include <stdio.h>
static uint64_t seed = 1, hash = 14695981039346656037u;
static double unit() {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(seed >> 11) * 0x1p-52 - 1.0;
}
static void take(const double* out, int count) {
  for (int i = 0; i < count; ++i) {
    uint64_t bits = 0;
    if (out[i] == out[i]) memcpy(&bits, out + i, sizeof bits);
    hash = (hash ^ bits) * 1099511628211u;
  }
}
int main() {
  double psi[16], psid[16], input[256], t, out[4096], k[4096];
  (void)k;
)";
  const int n = scene->n(), n_u = scene->n_u();
  const std::vector<double> start = start_at_home(*scene);
  text += fmt::format("  const double home[] = {{{}}}, start[] = {{{}}}, parameters[] = {{{}}};\n",
                      numbers(scene->home), numbers(start), numbers(scene->default_parameters()));
  for (Purpose purpose : kTried) {
    const int takes = signature(purpose).input_size(n, n_u);
    text += fmt::format(R"(
  mixloop_{0}_set_up(parameters, k);
  for (int trial = 0; trial < 200; ++trial) {{
    for (int i = 0; i < {1}; ++i) psi[i] = home[i] + {2} * unit(), psid[i] = 3 * unit();
    for (int i = 0; i < {3}; ++i) input[i] = 5 * unit();
    for (int i = 0; i < {4}; ++i) input[{3} + i] = start[i];
    t = 1e-3 * unit();
    mixloop_{0}(psi, psid, input, t, k, out);
    take(out, {5});
  }}
)",
                        name_of(purpose), n, scene->is_closed() ? 0.02 : 20.0, takes, start.size(),
                        trace(scene, purpose).program.outputs.size());
  }
  return text + "  printf(\"%016llx\\n\", (unsigned long long)hash);\n}\n";
}

class Elsewhere : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    scene_ = std::make_shared<const Scene>(load_scene(fs::path(MIXLOOP_SCENES) / (GetParam() + ".yaml")));
    source_ = folder_.write("hash.cpp", hashing_program(scene_));
    std::ifstream file(MIXLOOP_SOURCE "/tests/golden/bits.txt");
    for (std::string line, name, hash; std::getline(file, line);)
      if (std::istringstream(line) >> name >> hash && name == GetParam()) golden_ = hash;
  }

  static bool has(const std::string& program) {
    return std::system((program + " --version > /dev/null 2>&1").c_str()) == 0;
  }

  std::string hash_by(const std::string& compiler, const std::string& flags, const std::string& runner = "") {
    const std::string program = folder_.file("hash"), out = folder_.file("out");
    const std::string build =
        fmt::format("{} -std=c++17 -ffp-contract=off {} {} -o {}", compiler, flags, source_, program);
    if (std::system(build.c_str()) != 0) return "not built";
    if (std::system(fmt::format("{} {} > {}", runner, program, out).c_str()) != 0) return "not run";
    std::string hash;
    std::ifstream(out) >> hash;
    return hash;
  }

  std::shared_ptr<const Scene> scene_;
  const ScratchFolder folder_;
  std::string source_;
  std::string golden_ = "none in tests/golden/bits.txt";
};

TEST_P(Elsewhere, ThisMachinesCodeHasTheBitsThatAreWrittenDown) {
  std::string flags;
  for (const std::string& flag : machine_code_flags())
    if (flag != "-shared") flags += flag + " ";
  EXPECT_EQ(hash_by("g++", flags), golden_);
}

TEST_P(Elsewhere, SoHasAnotherProcessors) {
  if (!has("aarch64-linux-gnu-g++") || !has("qemu-aarch64"))
    GTEST_SKIP() << "no compiler for AArch64 (g++-aarch64-linux-gnu), or nothing to run its code (qemu-user)";
  EXPECT_EQ(hash_by("aarch64-linux-gnu-g++", "-O2 -static", "qemu-aarch64"), golden_);
}

TEST_P(Elsewhere, SoHasAnotherCompilers) {
  if (!has("clang++")) GTEST_SKIP() << "no clang++";
  EXPECT_EQ(hash_by("clang++", "-O2 -march=native"), golden_);
}

// Of this family, but without fused operations, and the C library's in their place.
TEST_P(Elsewhere, SoHasAnOldProcessorsCode) { EXPECT_EQ(hash_by("g++", "-O1 -march=x86-64"), golden_); }

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(MIXLOOP_SCENES))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Shipped, Elsewhere, ::testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace mixloop
