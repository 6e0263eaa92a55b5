#include "solvers/contact/friction_complementarity.hpp"

#include <drev/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dense/factorization.hpp"
#include "solvers/contact/linear_complementarity.hpp"

namespace drev {

namespace {

constexpr double kRounding = 1e-13;  // rounding of a sum over the largest of its terms

/// A quantity over the variables z >= 0 and the free torques f.
struct Affine {
  double constant = 0.0;
  Eigen::VectorXd z, f;
};

class FrictionProblem {
 public:
  FrictionProblem(const BoxComplementarity& p, const std::vector<GearLossRow>& gears)
      : p_(p), gears_(gears), n_(p.r.size()), gear_of_(static_cast<std::size_t>(p.r.size()), -1) {
    for (std::size_t g = 0; g < gears.size(); ++g)
      gear_of_[static_cast<std::size_t>(gears[g].loss)] = static_cast<int>(g);
    count();
    state();
  }

  FrictionSolution solve() {
    // Free torques: (W F) f = r - W (c + Z z) in their rows.
    const Eigen::Index nz = variables_, nf = static_cast<Eigen::Index>(free_.size());
    Eigen::MatrixXd z_part(n_, nz), f_part(n_, nf);
    Eigen::VectorXd constant(n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const Affine& l = lambda_[static_cast<std::size_t>(i)];
      constant[i] = l.constant;
      z_part.row(i) = l.z.transpose();
      f_part.row(i) = l.f.transpose();
    }
    Eigen::VectorXd f_0 = Eigen::VectorXd::Zero(nf);
    Eigen::MatrixXd f_z = Eigen::MatrixXd::Zero(nf, nz);
    if (nf > 0) {
      const Eigen::MatrixXd rows = w_(free_, Eigen::all);
      const LuFactor lu(rows * f_part);
      const Eigen::VectorXd right = r_(free_) - rows * constant;
      const Eigen::MatrixXd right_z = rows * z_part;
      f_0 = lu.solve(right);
      f_z = -lu.solve(right_z);
    }
    const Eigen::VectorXd lambda_0 = constant + f_part * f_0;
    const Eigen::MatrixXd lambda_z = z_part + f_part * f_z;
    const Eigen::VectorXd a_0 = r_ - w_ * lambda_0;
    const Eigen::MatrixXd a_z = -(w_ * lambda_z);
    const double largest = std::max(r_.lpNorm<Eigen::Infinity>(), lambda_0.lpNorm<Eigen::Infinity>());
    Eigen::VectorXd q(nz);
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(nz, nz);
    for (Eigen::Index k = 0; k < nz; ++k) {
      const Condition& c = conditions_[static_cast<std::size_t>(k)];
      q[k] = c.w.constant;
      m.row(k) = c.w.z.transpose();
      if (nf > 0) {
        q[k] += c.w.f.dot(f_0);
        m.row(k) += c.w.f.transpose() * f_z;
      }
      if (c.of_acceleration >= 0) {
        q[k] += c.sign * a_0[c.of_acceleration];
        m.row(k) += c.sign * a_z.row(c.of_acceleration);
      }
      const Eigen::Index of = c.of_acceleration;
      const double rounding = std::max(of >= 0 ? p_.rounding[of] * scale_[of] : 0.0, kRounding * largest);
      if (std::abs(q[k]) <= rounding) q[k] = 0.0;
    }
    const double nothing = kRounding * (1.0 + (nz > 0 ? lambda_z.cwiseAbs().maxCoeff() : 0.0));
    m = (m.array().abs() > nothing).select(m, 0.0);
    const bool finite = q.allFinite() && m.allFinite();
    auto found = finite ? solve_complementarity(m, q) : std::nullopt;
    // M is not copositive where a self-locking gear's load is heavy: Lemke's method may end on a ray beside a solution.
    if (!found && finite) found = try_every_set(m, q, at_rest_set());
    if (found && wedges(*found, a_0 + a_z * found->z))
      if (auto other = try_every_set(m, q, friction_holds_set())) found = std::move(other);
    if (!found)
      throw SolverError(
          "the torques of dry friction and lossy gears have no solution at this instant: a self-locking gear "
          "jams (an "
          "efficiency_backward below 0 with a load of large inertia), or contacts are tied to each other "
          "within rounding");
    FrictionSolution result;
    result.lambda = lambda_0 + lambda_z * found->z;
    result.a = a_0 + a_z * found->z;
    result.a = result.a.cwiseQuotient(scale_);
    result.lambda = result.lambda.cwiseProduct(scale_);
    for (const Eigen::Index i : free_) result.a[i] = 0.0;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const int side = side_of(i, *found);
      result.side.push_back(side);
      if (gear_of_[static_cast<std::size_t>(i)] >= 0) continue;
      if (side > 0) result.lambda[i] = p_.high[i];
      if (side < 0) result.lambda[i] = p_.low[i];
    }
    for (const GearLossRow& g : gears_) {
      const Variables& v = of_[static_cast<std::size_t>(g.loss)];
      const int side = result.side[static_cast<std::size_t>(g.loss)];
      const std::vector<GearLossRow::Line>& lines = side < 0 ? g.low : g.high;
      const int other = side < 0 ? v.low_line : v.high_line;
      const bool second = other >= 0 && !holds(other, *found);
      result.line.push_back(side == 0 ? -1 : lines[second ? 1 : 0].number);
    }
    return result;
  }

 private:
  static constexpr char kAny = 2;  // of a variable: whether it is basic does not matter

  struct Condition {
    Affine w;
    Eigen::Index of_acceleration = -1;  ///< a further term: sign times that row's acceleration
    double sign = 1.0;
  };
  /// Variables of a row; -1: none.
  struct Variables {
    int below_high = -1, above_low = -1, backward = -1, high_line = -1, low_line = -1;
    int fixed = 0;  ///< side of one that turns, or whose bounds are the same
    int free = -1;
  };

  static bool holds(int variable, const ComplementarySolution& found) {
    return variable >= 0 && !found.basic[static_cast<std::size_t>(variable)];
  }
  /// 1: the row is on its high bound, -1: on its low one.
  int side_of(Eigen::Index i, const ComplementarySolution& found) const {
    const Variables& v = of_[static_cast<std::size_t>(i)];
    if (v.below_high >= 0) {  // lambda = high - u
      if (holds(v.below_high, found)) return 1;
      return v.backward >= 0 && !holds(v.backward, found) ? -1 : v.fixed;
    }
    return holds(v.above_low, found) ? -1 : v.fixed;
  }
  bool is_gear(Eigen::Index i) const { return gear_of_[static_cast<std::size_t>(i)] >= 0; }

  /// Whether a self-locking gear at rest stands between its bounds beside friction that is on its own, though nothing moves.
  /// The friction presses the gear then harder than what drives it, and where that turns there is no way on.
  bool wedges(const ComplementarySolution& found, const Eigen::VectorXd& a) const {
    const bool between = std::ranges::any_of(gears_, [&](const GearLossRow& g) {
      const auto locks = [](const GearLossRow::Line& line) { return line.slope <= -1.0; };
      return side_of(g.loss, found) == 0 &&
             (std::ranges::any_of(g.high, locks) || std::ranges::any_of(g.low, locks));
    });
    if (!between) return false;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double rounding = p_.rounding[i] * scale_[i] + kRounding * r_.lpNorm<Eigen::Infinity>();
      if (!is_gear(i) && side_of(i, found) != 0 && std::abs(a[i]) <= rounding) return true;
    }
    return false;
  }

  /// Which variables are basic where nothing at rest moves; that of lines does not matter.
  std::vector<char> at_rest_set() const {
    std::vector<char> basic(static_cast<std::size_t>(variables_), kAny);
    for (Eigen::Index i = 0; i < n_; ++i) put_between(i, basic);
    return basic;
  }
  /// Where friction stands between its bounds; what gears do does not matter.
  std::vector<char> friction_holds_set() const {
    std::vector<char> basic(static_cast<std::size_t>(variables_), kAny);
    for (Eigen::Index i = 0; i < n_; ++i)
      if (!is_gear(i)) put_between(i, basic);
    return basic;
  }
  void put_between(Eigen::Index i, std::vector<char>& basic) const {
    const Variables& v = of_[static_cast<std::size_t>(i)];
    for (const auto& [variable, value] : {std::pair{v.below_high, 1}, {v.above_low, 1}, {v.backward, 0}})
      if (variable >= 0) basic[static_cast<std::size_t>(variable)] = static_cast<char>(value);
  }
  void count() {
    scale_.resize(n_);
    for (Eigen::Index i = 0; i < n_; ++i) scale_[i] = p_.w(i, i) > 0.0 ? 1.0 / std::sqrt(p_.w(i, i)) : 1.0;
    w_ = scale_.asDiagonal() * p_.w * scale_.asDiagonal();
    r_ = p_.r.cwiseProduct(scale_);
    of_.resize(static_cast<std::size_t>(n_));
    for (Eigen::Index i = 0; i < n_; ++i) {
      Variables& v = of_[static_cast<std::size_t>(i)];
      const int gear = gear_of_[static_cast<std::size_t>(i)];
      bool high = std::isfinite(p_.high[i]), low = std::isfinite(p_.low[i]);
      if (gear >= 0) {
        const GearLossRow& g = gears_[static_cast<std::size_t>(gear)];
        high = !g.high.empty() && g.turns >= 0;
        low = !g.low.empty() && g.turns <= 0;
        if (high && g.high.size() > 1) v.high_line = variables_++;
        if (low && g.low.size() > 1) v.low_line = variables_++;
        v.fixed = g.turns;
      } else if (high && low && p_.low[i] == p_.high[i]) {
        v.fixed = 1;
      }
      if (v.fixed != 0) continue;
      if (high) {
        v.below_high = variables_++;
        if (low) v.backward = variables_++;
      } else if (low) {
        v.above_low = variables_++;
      } else {
        v.free = static_cast<int>(free_.size());
        free_.push_back(i);
      }
    }
  }

  Affine affine(double constant = 0.0) const {
    return {constant, Eigen::VectorXd::Zero(variables_),
            Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free_.size()))};
  }
  static void add(Affine& to, const Affine& other, double factor) {
    to.constant += factor * other.constant;
    to.z += factor * other.z;
    to.f += factor * other.f;
  }
  /// In scaled torques.
  Affine line(const GearLossRow& g, const GearLossRow::Line& line) const {
    Affine x = affine(line.constant / scale_[g.loss]);
    x.f[of_[static_cast<std::size_t>(g.tie)].free] = line.slope * scale_[g.tie] / scale_[g.loss];
    return x;
  }

  void state() {
    conditions_.assign(static_cast<std::size_t>(variables_), {});
    for (Condition& c : conditions_) c.w = affine();
    for (Eigen::Index i = 0; i < n_; ++i) lambda_.push_back(affine());
    for (Eigen::Index i = 0; i < n_; ++i) {
      const Variables& v = of_[static_cast<std::size_t>(i)];
      Affine& lambda = lambda_[static_cast<std::size_t>(i)];
      if (v.free >= 0) {
        lambda.f[v.free] = 1.0;
        continue;
      }
      Affine high = affine(p_.high[i] / scale_[i]), low = affine(p_.low[i] / scale_[i]);
      if (const int gear = gear_of_[static_cast<std::size_t>(i)]; gear >= 0) {
        const GearLossRow& g = gears_[static_cast<std::size_t>(gear)];
        if (!g.high.empty()) high = line(g, g.high[0]);
        if (!g.low.empty()) low = line(g, g.low[0]);
        if (v.high_line >= 0) {  // high = line 0 + y, and not below line 1
          high.z[v.high_line] = 1.0;
          Affine& slack = conditions_[static_cast<std::size_t>(v.high_line)].w;
          slack = high;
          add(slack, line(g, g.high[1]), -1.0);
        }
        if (v.low_line >= 0) {
          low.z[v.low_line] = -1.0;
          Affine& slack = conditions_[static_cast<std::size_t>(v.low_line)].w;
          slack = line(g, g.low[1]);
          add(slack, low, -1.0);
        }
      }
      if (v.fixed != 0) {
        lambda = v.fixed > 0 ? high : low;
      } else if (v.above_low >= 0) {
        lambda = low;
        lambda.z[v.above_low] += 1.0;
        accelerates(v.above_low, i, -1.0);
      } else {
        lambda = high;
        lambda.z[v.below_high] -= 1.0;
        accelerates(v.below_high, i, 1.0);
        if (v.backward < 0) continue;
        conditions_[static_cast<std::size_t>(v.below_high)].w.z[v.backward] += 1.0;  // a+ = a + a-
        Affine& slack = conditions_[static_cast<std::size_t>(v.backward)].w;
        slack = lambda;
        add(slack, low, -1.0);
      }
    }
  }
  void accelerates(int variable, Eigen::Index row, double sign) {
    Condition& c = conditions_[static_cast<std::size_t>(variable)];
    c.of_acceleration = row;
    c.sign = sign;
  }

  const BoxComplementarity& p_;
  const std::vector<GearLossRow>& gears_;
  Eigen::Index n_;
  std::vector<int> gear_of_;
  Eigen::VectorXd scale_, r_;
  Eigen::MatrixXd w_;
  int variables_ = 0;
  std::vector<Eigen::Index> free_;
  std::vector<Variables> of_;
  std::vector<Affine> lambda_;
  std::vector<Condition> conditions_;
};

}  // namespace

FrictionSolution solve(const BoxComplementarity& problem, const std::vector<GearLossRow>& gears) {
  if (!gears.empty()) return FrictionProblem(problem, gears).solve();
  BoxSolution found = solve(problem);
  FrictionSolution result{std::move(found.lambda), std::move(found.a), {}, {}};
  for (Eigen::Index i = 0; i < problem.r.size(); ++i) {
    const bool free = found.free[static_cast<std::size_t>(i)] != 0;
    result.side.push_back(free ? 0 : result.lambda[i] == problem.high[i] ? 1 : -1);
  }
  return result;
}

}  // namespace drev
