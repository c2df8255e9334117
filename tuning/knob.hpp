// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "loop/experiment.hpp"
#include "sweep/variation.hpp"

namespace mixloop {

/// A number of an experiment, or of its scene, that is tuned between two ends; all in the unit that stands in
/// the file.
struct Knob {
  std::string key;  ///< as --set takes it, of a list's element `controller.kp[0]`
  Place place;
  std::string unit;  ///< behind the number in the file; may be empty
  double now = 0;    ///< as it stands
  double least = 0, most = 0;

  /// It is searched by its logarithm: both ends lie on one side of zero.
  bool is_logarithmic() const { return least * most > 0; }
  /// Of a share of the way from `least` to `most`, to six digits, as it will be written.
  double value(double share) const;
  /// Back.
  double share(double value) const;
  /// As it is written into the experiment.
  std::string text_of(double value) const;
  /// As a sweep varies it, its one value that which stands: beside it others are set run by run.
  Variation as_variation() const;
};

/// Of `KEY` or `KEY=FROM..TO`, several parted by commas; a list's key means each of its numbers. Without ends
/// they are a tenth and ten times what stands. Throws InputError at `--over KEY`.
std::vector<Knob> read_knobs(const std::vector<std::string>& over, const NodePtr& experiment,
                             const ExperimentScenes& scenes);

}  // namespace mixloop
