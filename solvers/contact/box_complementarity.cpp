#include "solvers/contact/box_complementarity.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

class BoundedLeastSquares {
 public:
  explicit BoundedLeastSquares(const BoxComplementarity& p) : p_(p), n_(p.r.size()) {
    result_.free = p.free;
    result_.free.resize(static_cast<std::size_t>(n_), 0);
    result_.lambda.resize(n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double nearest = std::clamp(0.0, p.low[i], p.high[i]);
      const double low = std::isfinite(p.low[i]) ? p.low[i] : p.high[i];
      result_.lambda[i] = is_free(i) ? nearest : std::isfinite(low) ? low : 0.0;
      if (!std::isfinite(low)) free(i) = 1;
    }
  }

  BoxSolution solve() {
    std::vector<char> tried(static_cast<std::size_t>(n_), 0);  // freed without effect since the last gain
    settle();
    const Eigen::Index most = 20 + 10 * n_ * n_;
    for (Eigen::Index round = 0; round < most; ++round) {
      result_.a = p_.r - p_.w * result_.lambda;
      Eigen::Index worst = -1;
      double largest = 0.0;
      for (Eigen::Index i = 0; i < n_; ++i) {
        if (is_free(i) || tried[static_cast<std::size_t>(i)] || p_.low[i] == p_.high[i]) continue;
        const double inward = result_.lambda[i] == p_.high[i] ? -result_.a[i] : result_.a[i];
        if (inward <= p_.rounding[i]) continue;
        const double size = inward / std::sqrt(p_.w(i, i));
        if (size > largest) largest = size, worst = i;
      }
      if (worst < 0) return std::move(result_);
      free(worst) = 1;
      const double before = result_.lambda[worst];
      settle();
      if (result_.lambda[worst] == before)
        tried[static_cast<std::size_t>(worst)] = 1;
      else
        std::fill(tried.begin(), tried.end(), 0);
    }
    throw SolverError("the torques of dry friction could not be solved for: its " + std::to_string(n_) +
                      " contacts are tied to each other within rounding");
  }

 private:
  bool is_free(Eigen::Index i) const { return result_.free[static_cast<std::size_t>(i)] != 0; }
  char& free(Eigen::Index i) { return result_.free[static_cast<std::size_t>(i)]; }

  /// Moves the free variables towards a = 0; those that meet a bound stay there.
  void settle() {
    for (;;) {
      std::vector<Eigen::Index> of;
      for (Eigen::Index i = 0; i < n_; ++i)
        if (is_free(i)) of.push_back(i);
      if (of.empty()) return;
      const Eigen::MatrixXd w = p_.w(of, of);
      Eigen::VectorXd rest = p_.r(of);
      for (Eigen::Index i = 0; i < n_; ++i)
        if (!is_free(i)) rest -= p_.w(of, i) * result_.lambda[i];
      const Eigen::VectorXd target = ldlt_solve(w, rest);
      double part = 1.0;
      Eigen::Index first = -1;
      for (std::size_t k = 0; k < of.size(); ++k) {
        const Eigen::Index i = of[k];
        const double from = result_.lambda[i], to = target[static_cast<Eigen::Index>(k)];
        const double bound = to > p_.high[i] ? p_.high[i] : to < p_.low[i] ? p_.low[i] : to;
        if (bound == to || to == from) continue;
        const double reach = (bound - from) / (to - from);
        if (first < 0 || reach < part) part = reach, first = i;
      }
      for (std::size_t k = 0; k < of.size(); ++k) {
        double& value = result_.lambda[of[k]];
        value += std::max(part, 0.0) * (target[static_cast<Eigen::Index>(k)] - value);
      }
      if (first < 0) return;
      // The first to meet its bound stands on it.
      for (std::size_t k = 0; k < of.size(); ++k)
        if (of[k] == first)
          result_.lambda[first] =
              target[static_cast<Eigen::Index>(k)] > p_.high[first] ? p_.high[first] : p_.low[first];
      free(first) = 0;
    }
  }

  const BoxComplementarity& p_;
  Eigen::Index n_;
  BoxSolution result_;
};

}  // namespace

BoxSolution solve(const BoxComplementarity& problem) { return BoundedLeastSquares(problem).solve(); }

}  // namespace drev
