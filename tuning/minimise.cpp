// SPDX-License-Identifier: MIT
#include "tuning/minimise.hpp"

#include <nlopt.h>

#include <exception>
#include <memory>
#include <stdexcept>

namespace mixloop {
namespace {

/// What NLopt's functions in C get to see of a search: exceptions don't go through them.
class Search {
 public:
  Search(nlopt_algorithm algorithm, const Minimisation& problem, std::size_t unknowns)
      : problem_(problem), opt_(nlopt_create(algorithm, static_cast<unsigned>(unknowns)), nlopt_destroy) {
    require(opt_ ? NLOPT_SUCCESS : NLOPT_OUT_OF_MEMORY);
    require(nlopt_set_lower_bounds1(opt_.get(), 0));
    require(nlopt_set_upper_bounds1(opt_.get(), 1));
    require(nlopt_set_min_objective(opt_.get(), objective, this));
    const std::vector<double> exact(problem.constraints, 0);
    if (!exact.empty())
      require(nlopt_add_inequality_mconstraint(opt_.get(), static_cast<unsigned>(exact.size()), constraints,
                                               this, exact.data()));
  }

  nlopt_opt opt() { return opt_.get(); }

  /// Rounding may end it, or whoever looks at the points.
  void run(std::vector<double> at) {
    double least = 0;
    const nlopt_result result = nlopt_optimize(opt_.get(), at.data(), &least);
    if (failure_) std::rethrow_exception(failure_);
    if (result != NLOPT_ROUNDOFF_LIMITED && result != NLOPT_FAILURE) require(result);
  }

 private:
  static void require(nlopt_result result) {
    if (result < 0)
      throw std::runtime_error(std::string("NLopt can't search: ") + nlopt_result_to_string(result));
  }

  const Minimisation::Value& at(std::span<const double> x) {
    if (last_.size() == x.size() && std::equal(x.begin(), x.end(), last_.begin())) return value_;
    value_ = problem_.at(x);
    last_.assign(x.begin(), x.end());
    return value_;
  }

  template <class Use>
  void guarded(std::span<const double> x, const Use& use) {
    if (failure_) return;
    try {
      use(at(x));
    } catch (...) {
      failure_ = std::current_exception();
      nlopt_force_stop(opt_.get());
    }
  }

  static double objective(unsigned n, const double* x, double* /*gradient*/, void* self) {
    double result = 0;
    static_cast<Search*>(self)->guarded({x, n}, [&](const auto& value) { result = value.objective; });
    return result;
  }
  static void constraints(unsigned m, double* result, unsigned n, const double* x, double* /*gradient*/,
                          void* self) {
    std::fill(result, result + m, 0.0);
    static_cast<Search*>(self)->guarded({x, n}, [&](const auto& value) {
      std::copy(value.constraints.begin(), value.constraints.end(), result);
    });
  }

  const Minimisation& problem_;
  std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt_;
  std::vector<double> last_;
  Minimisation::Value value_;
  std::exception_ptr failure_;
};

}  // namespace

bool can_minimise() { return true; }

void look_around(const Minimisation& problem, std::size_t unknowns, int evaluations) {
  Search search(NLOPT_GN_ORIG_DIRECT_L, problem, unknowns);
  nlopt_set_maxeval(search.opt(), evaluations);
  search.run(std::vector<double>(unknowns, 0.5));
}

void go_down(const Minimisation& problem, const std::vector<double>& start, double step, double end) {
  Search search(NLOPT_LN_COBYLA, problem, start.size());
  nlopt_set_initial_step1(search.opt(), step);
  nlopt_set_xtol_abs1(search.opt(), end);
  search.run(start);
}

}  // namespace mixloop
