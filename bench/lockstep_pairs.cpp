// SPDX-License-Identifier: MIT
// Compares a lockstep run with the bare exchange of its messages, in interleaved pairs, because runs of
// either vary by a quarter. To be run in a network namespace of its own:
//   tools/in-namespace lockstep_pairs [--pairs 15] [--bare "COMMAND"] -- COMMAND...
// Both commands print one JSON object with "round_trip_p50", "round_trip_p99" and
// either "ticks" and "wall_time", or "rate". Prints the medians and the medians of the pairs' ratios.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Figures {
  double rate, p50, p99;
};

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start: " + command);
  std::string text;
  char block[4096];
  for (std::size_t got; (got = fread(block, 1, sizeof block, pipe)) > 0;) text.append(block, got);
  if (const int status = pclose(pipe); status != 0)
    throw std::runtime_error("status " + std::to_string(status) + " from: " + command);
  return text;
}

Figures run(const std::string& command) {
  const std::string text = output_of(command);
  const nlohmann::json j = nlohmann::json::parse(text.substr(text.find('{')));
  // `mixloop run` has a rate, too: the experiment's.
  const double rate = j.contains("wall_time") ? j.at("ticks").get<double>() / j.at("wall_time").get<double>()
                                              : j.at("rate").get<double>();
  return {.rate = rate, .p50 = j.at("round_trip_p50"), .p99 = j.at("round_trip_p99")};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void print(const char* what, const std::vector<Figures>& bare, const std::vector<Figures>& ours,
           double Figures::*f, double unit) {
  std::vector<double> a, b, ratio;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    a.push_back(bare[i].*f);
    b.push_back(ours[i].*f);
    ratio.push_back(b.back() / a.back());
  }
  std::printf("%-22s %10.1f %10.1f %8.3f   (%.3f to %.3f)\n", what, median(a) * unit, median(b) * unit,
              median(ratio), *std::min_element(ratio.begin(), ratio.end()),
              *std::max_element(ratio.begin(), ratio.end()));
}

}  // namespace

int main(int argc, char** argv) try {
  int pairs = 15;
  std::string bare_command =
      quoted((std::filesystem::read_symlink("/proc/self/exe").parent_path() / "lockstep_bare"));
  std::string command;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--pairs" && i + 1 < argc) {
      pairs = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--bare" && i + 1 < argc) {
      bare_command = argv[++i];
    } else if (word == "--") {
      for (++i; i < argc; ++i) command += quoted(argv[i]) + " ";
    }
  }
  if (command.empty()) {
    std::fprintf(stderr, "usage: lockstep_pairs [--pairs 15] [--bare \"COMMAND\"] -- COMMAND...\n");
    return 2;
  }
  std::vector<Figures> bare, ours;
  for (int i = 0; i < pairs; ++i) {
    // Which goes first alternates, so that a drift of the machine favours neither.
    if (i % 2 == 0) bare.push_back(run(bare_command));
    ours.push_back(run(command));
    if (i % 2 == 1) bare.push_back(run(bare_command));
  }
  std::printf("%d interleaved pairs, medians %10s %10s %8s   (range)\n", pairs, "bare", "this", "ratio");
  print("rate, 1/s", bare, ours, &Figures::rate, 1);
  print("round trip p50, us", bare, ours, &Figures::p50, 1e6);
  print("round trip p99, us", bare, ours, &Figures::p99, 1e6);
} catch (const std::exception& e) {
  std::fprintf(stderr, "lockstep_pairs: %s\n", e.what());
  return 3;
}
