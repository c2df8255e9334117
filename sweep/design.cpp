// SPDX-License-Identifier: MIT
#include "sweep/design.hpp"

#include <fmt/format.h>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kMostRuns = 1'000'000'000'000;

/// One entry within another would have its value, or not, by who comes last.
bool overlap(const std::string& a, const std::string& b) {
  const auto& [shorter, longer] = a.size() < b.size() ? std::tie(a, b) : std::tie(b, a);
  return longer.starts_with(shorter) &&
         (longer.size() == shorter.size() || longer[shorter.size()] == '.' || longer[shorter.size()] == '[');
}

void require_distinct(const std::vector<Variation>& variations) {
  for (std::size_t i = 0; i < variations.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (overlap(variations[i].key, variations[j].key))
        throw InputError("doubly_defined", variations[i].place,
                         fmt::format("{} is varied already, by {}; expected each entry once",
                                     in_quotes(variations[i].key), in_quotes(variations[j].key)));
}

}  // namespace

std::string_view name_of(Spread spread) {
  static constexpr std::string_view kNames[] = {"latin", "sobol", "random"};
  return kNames[static_cast<std::size_t>(spread)];
}

Design::Design(Settings settings)
    : variations_(std::move(settings.varied)),
      varied_(variations_.size()),
      draws_(settings.sampled.empty() ? 1 : settings.draws),
      spread_(settings.spread),
      chance_(settings.seed) {
  variations_.insert(variations_.end(), settings.sampled.begin(), settings.sampled.end());
  if (variations_.empty())
    throw InputError("missing_key", {"sweep"},
                     "nothing is varied; expected --vary KEY=FROM..TO:COUNT or --sample "
                     "KEY='normal(MEAN, STD)', e.g. --vary parameters.payload='0..5 kg:11'");
  require_distinct(variations_);
  runs_ = draws_;
  for (std::size_t i = 0; i < varied_; ++i) {
    if (runs_ > kMostRuns / variations_[i].size())
      throw InputError("too_large", variations_[i].place,
                       fmt::format("more than {} runs; expected fewer values", kMostRuns));
    runs_ *= variations_[i].size();
  }
  const std::size_t dimensions = settings.sampled.size();
  if (dimensions > Sobol::kMostDimensions)
    throw InputError(
        "too_large", variations_.back().place,
        fmt::format("{} entries are sampled; expected {} at most", dimensions, Sobol::kMostDimensions));
  if (spread_ == Spread::sobol) sobol_.emplace(dimensions, chance_);
  if (spread_ == Spread::latin)
    for (std::size_t i = 0; i < dimensions; ++i) strata_.emplace_back(draws_, chance_, i);
}

/// A share in (0, 1) of what is drawn from.
double Design::drawn(std::int64_t draw, std::size_t dimension) const {
  if (spread_ == Spread::sobol) return sobol_->at(draw, dimension);
  const double within =
      0x1p-52 * (static_cast<double>(chance_.bits(draw, dimension, Draw::sample) >> 12) + 0.5);
  if (spread_ == Spread::random) return within;
  // M. D. McKay, R. J. Beckman & W. J. Conover (1979): one in each of as many strata.
  const double share =
      (static_cast<double>(strata_[dimension].at(draw)) + within) / static_cast<double>(draws_);
  return std::min(share, 1 - 0x1p-53);  // the last stratum's end rounds to 1
}

void Design::numbers(std::int64_t run, std::span<double> numbers) const {
  std::int64_t combination = run / draws_;
  for (std::size_t i = varied_; i-- > 0; combination /= variations_[i].size()) {
    const std::int64_t at = combination % variations_[i].size();
    numbers[i] = variations_[i].is_number() ? variations_[i].numbers[static_cast<std::size_t>(at)]
                                            : static_cast<double>(at);
  }
  for (std::size_t i = varied_; i < variations_.size(); ++i)
    numbers[i] = variations_[i].distribution->quantile(drawn(draw_of(run), i - varied_));
}

std::vector<RunValue> Design::values(std::int64_t run) const {
  std::vector<double> numbers(variations_.size());
  this->numbers(run, numbers);
  std::vector<RunValue> values(variations_.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Variation& variation = variations_[i];
    values[i] = {numbers[i], variation.is_number() ? variation.text_of(numbers[i])
                                                   : variation.texts[static_cast<std::size_t>(numbers[i])]};
  }
  return values;
}

std::vector<Override> Design::overrides(std::int64_t run) const {
  std::vector<Override> overrides;
  const std::vector<RunValue> values = this->values(run);
  for (std::size_t i = 0; i < values.size(); ++i) overrides.push_back({variations_[i].key, values[i].text});
  return overrides;
}

}  // namespace mixloop
