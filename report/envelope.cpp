// SPDX-License-Identifier: MIT
#include "report/envelope.hpp"

#include <cmath>

namespace mixloop {

Envelope::Envelope(std::size_t capacity) : capacity_(capacity) { buckets_.reserve(capacity); }

Envelope::Bucket Envelope::joined(const Bucket& first, const Bucket& second) {
  if (std::isnan(first.least)) return second;
  if (std::isnan(second.least)) return first;
  const bool least_first = first.least <= second.least, greatest_first = first.greatest >= second.greatest;
  // Both from one of them: its own order; else the one from `first` came first.
  const bool falls =
      least_first == greatest_first ? (least_first ? first.falls : second.falls) : greatest_first;
  return {least_first ? first.least : second.least, greatest_first ? first.greatest : second.greatest, falls};
}

void Envelope::add(double value) {
  const auto number = std::isfinite(value) ? static_cast<float>(value) : NAN;
  seen_ = seen_ || !std::isnan(number);
  const Bucket alone{number, number, false};
  if (!buckets_.empty() && in_last_ < width_) {
    buckets_.back() = joined(buckets_.back(), alone);
    ++in_last_;
    return;
  }
  if (buckets_.size() == capacity_) {
    coarsen();
    return add(value);
  }
  buckets_.push_back(alone);
  in_last_ = 1;
}

void Envelope::coarsen() {
  const std::size_t before = buckets_.size();
  if (before > 0) in_last_ += before % 2 == 0 ? width_ : 0;
  for (std::size_t i = 0; 2 * i < before; ++i)
    buckets_[i] = 2 * i + 1 < before ? joined(buckets_[2 * i], buckets_[2 * i + 1]) : buckets_[2 * i];
  buckets_.resize((before + 1) / 2);
  width_ *= 2;
}

std::vector<float> Envelope::points() const {
  std::vector<float> all;
  all.reserve(buckets_.size() * (width_ == 1 ? 1 : 2));
  for (const Bucket& bucket : buckets_) {
    all.push_back(bucket.falls ? bucket.greatest : bucket.least);
    if (width_ > 1) all.push_back(bucket.falls ? bucket.least : bucket.greatest);
  }
  return all;
}

}  // namespace mixloop
