// Random piecewise-linear models: exact propagation against matrix exponentials of the pieces that
// it says hold. Between the ends of each step no bound of a piece may be violated (a missed
// change), the step's end must be that of the exponential, and the energy must balance. More models are
// looked at by points that the run itself shows, and models that are not linear in pieces by runs with
// other steps.
#include <drev/core/assembler.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <Eigen/Dense>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/stability/random_model.hpp"

using namespace drev;

namespace {

constexpr int kPhaseSamples = 50;

/// exp(A) by scaling, Taylor series and squaring.
Eigen::MatrixXd exponential(Eigen::MatrixXd a) {
  int halvings = 0;
  while (a.cwiseAbs().rowwise().sum().maxCoeff() > 0.5) a *= 0.5, ++halvings;
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(a.rows(), a.cols()), sum = term;
  for (int k = 1; k <= 14; ++k) sum += term = term * a / k;
  for (int i = 0; i < halvings; ++i) sum = sum * sum;
  return sum;
}

/// Watches a run: which pieces hold, and whether they may.
class PieceCheck final : public Observer {
 public:
  explicit PieceCheck(const System& system) : system_(system) {}
  void note(const ContactChange& change) { pending_.push_back(change); }

  void start(const Assembler&, const EvaluatedState& point) override {
    for (std::size_t j = 0; j < system_.scalars().size(); ++j) pieces_.push_back(-1);
    first_ = point.inputs;
  }

  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override {
    std::size_t done = 0;
    for (; done < pending_.size() && pending_[done].t <= from.state.t; ++done)
      pieces_[idx(pending_[done].law)] = pending_[done].to;
    check(assembler, from, to);
    for (; done < pending_.size(); ++done) pieces_[idx(pending_[done].law)] = pending_[done].to;
    pending_.clear();
  }

  double worst_bound = 0.0, worst_end = 0.0;
  long steps = 0;

 private:
  void find_first_pieces() {
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      const auto pieces = system_.scalars()[j].force->pieces();
      for (std::size_t i = 0; i < pieces.size() && pieces_[j] < 0; ++i) {
        bool inside = true;
        for (const LawBound& b : pieces[i].bounds)
          inside &= b.a + b.b_x * first_[j].x + b.b_v * first_[j].x_dot >= 0.0;
        if (inside) pieces_[j] = static_cast<int>(i);
      }
    }
  }

  void check(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
    find_first_pieces();
    const int n = system_.size();
    const double h = to.state.t - from.state.t;
    Eigen::MatrixXd m(n, n), c(n, n), k(n, n);
    Vector column(n);
    for (int i = 0; i < n; ++i) {
      const Vector unit = Vector::Unit(n, i);
      assembler.multiply_mass(unit, column), m.col(i) = column;
      assembler.multiply_damping(unit, column), c.col(i) = column;
      assembler.multiply_stiffness(unit, column), k.col(i) = column;
    }
    Vector p = from.p;
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      const LawPiece& piece = system_.scalars()[j].force->pieces()[idx(pieces_[j])];
      Vector b = Vector::Zero(n);
      for (const Entry& e : system_.scalars()[j].z) b[e.index] += e.coeff;
      k += piece.k * b * b.transpose();
      c += piece.c * b * b.transpose();
      p -= piece.y_0 * b;
    }
    // d/d(t/h) (z, h v, 1, t/h), balanced: loads are linear in time over a step.
    const Eigen::MatrixXd inverse = m.inverse();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n + 2, 2 * n + 2);
    a.block(0, n, n, n).setIdentity();
    a.block(n, 0, n, n) = -h * h * inverse * k;
    a.block(n, n, n, n) = -h * inverse * c;
    a.block(n, 2 * n, n, 1) = h * h * inverse * p;
    a.block(n, 2 * n + 1, n, 1) = h * h * inverse * (to.p - from.p);
    a(2 * n + 1, 2 * n) = 1.0;
    const Eigen::MatrixXd forward = exponential(a / kPhaseSamples);
    Vector y(2 * n + 2);
    y << from.state.z, h * from.state.v, 1.0, 0.0;
    for (const State* s : {&from.state, &to.state}) {
      z_scale_ = std::max(z_scale_, s->z.lpNorm<Eigen::Infinity>());
      v_scale_ = std::max(v_scale_, s->v.lpNorm<Eigen::Infinity>());
    }
    for (int i = 1; i <= kPhaseSamples; ++i) {
      y = forward * y;
      for (std::size_t j = 0; j < pieces_.size(); ++j) {
        double x = 0.0, x_dot = 0.0;
        for (const Entry& e : system_.scalars()[j].z) {
          x += e.coeff * y[e.index];
          x_dot += e.coeff * y[n + e.index] / h;
        }
        for (const LawBound& b : system_.scalars()[j].force->pieces()[idx(pieces_[j])].bounds) {
          const double scale = std::abs(b.a) + std::abs(b.b_x) * z_scale_ + std::abs(b.b_v) * v_scale_;
          worst_bound = std::max(worst_bound, -(b.a + b.b_x * x + b.b_v * x_dot) / scale);
        }
      }
    }
    worst_end = std::max({worst_end, (y.head(n) - to.state.z).lpNorm<Eigen::Infinity>() / z_scale_,
                          (y.segment(n, n) / h - to.state.v).lpNorm<Eigen::Infinity>() / v_scale_});
    ++steps;
  }

  const System& system_;
  std::vector<int> pieces_;
  std::vector<ScalarInput> first_;
  std::vector<ContactChange> pending_;
  double z_scale_ = 1e-300, v_scale_ = 1e-300;
};

/// At every point seen, 0.3/fastest apart at most, the pieces that the run says hold must.
class PointCheck final : public Observer {
 public:
  explicit PointCheck(const System& system) : system_(system) {}
  void note(const ContactChange& change) { pending_.push_back(change); }
  void start(const Assembler&, const EvaluatedState& point) override {
    pieces_.assign(system_.scalars().size(), -1);
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      const auto pieces = system_.scalars()[j].force->pieces();
      for (std::size_t i = 0; i < pieces.size() && pieces_[j] < 0; ++i)
        if (least_bound(pieces[i], point.inputs[j]) >= 0.0) pieces_[j] = static_cast<int>(i);
    }
  }
  void step(const Assembler&, const EvaluatedState& from, const EvaluatedState& to) override {
    std::size_t done = 0;
    for (; done < pending_.size() && pending_[done].t <= from.state.t; ++done)
      pieces_[idx(pending_[done].law)] = pending_[done].to;
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(done));
    z_scale_ = std::max(z_scale_, to.state.z.lpNorm<Eigen::Infinity>());
    v_scale_ = std::max(v_scale_, to.state.v.lpNorm<Eigen::Infinity>());
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      if (pieces_[j] < 0) continue;  // not a law of pieces
      worst_bound = std::max(
          worst_bound, -least_bound(system_.scalars()[j].force->pieces()[idx(pieces_[j])], to.inputs[j]));
    }
  }
  double worst_bound = 0.0;

 private:
  double least_bound(const LawPiece& piece, const ScalarInput& in) const {
    double least = 1.0;
    for (const LawBound& b : piece.bounds)
      least = std::min(least, (b.a + b.b_x * in.x + b.b_v * in.x_dot) /
                                  (std::abs(b.a) + std::abs(b.b_x) * z_scale_ + std::abs(b.b_v) * v_scale_));
    return least;
  }
  const System& system_;
  std::vector<int> pieces_;
  std::vector<ContactChange> pending_;
  double z_scale_ = 1e-300, v_scale_ = 1e-300;
};

constexpr int kMostCalls = 1000;  // of progress, every 100 steps: a run without end is stopped

/// Runs the model under the check's eyes. What holds for every piecewise-linear model is asked for here.
template <class Check>
RunSummary run_checked(const RandomModel& model, Check& check) {
  int calls = 0;
  const RunSummary run = propagate(model.system,
                                   {.tolerance = 1e-12,
                                    .t_end = model.t_end,
                                    .energy_tolerance = 1e-9,
                                    .progress = [&](double) { return ++calls < kMostCalls; },
                                    .on_change = [&](const ContactChange& c) { check.note(c); }},
                                   {&check});
  INFO(run.brief_report());
  CHECK(run.ok());
  CHECK(std::abs(run.energy.relative_error()) < 1e-10);
  CHECK(check.worst_bound < 1e-11);
  return run;
}

}  // namespace

TEST_CASE("Exact propagation, 800 random models: no change missed, energy kept, ends exact") {
  long changes = 0, steps = 0;
  for (unsigned seed = 1; seed <= 800; ++seed) {
    const RandomModel model = random_model(seed, {.duration = 150.0});
    INFO("seed " << seed);
    PieceCheck check(model.system);
    const RunSummary run = run_checked(model, check);
    CHECK(check.worst_end < 1e-10);
    changes += run.contact_changes;
    steps += check.steps;
  }
  // The models do what they are meant to.
  CHECK(changes > 10000);
  CHECK(steps > 10000);
}

TEST_CASE("Exact propagation, 1200 random models: pieces hold where they are said to, energy kept") {
  long changes = 0, steps = 0;
  for (unsigned seed = 801; seed <= 2000; ++seed) {
    const RandomModel model = random_model(seed, {});
    INFO("seed " << seed);
    PointCheck check(model.system);
    const RunSummary run = run_checked(model, check);
    changes += run.contact_changes;
    steps += run.steps;
  }
  CHECK(changes > 10000);
  CHECK(steps > 10000);
}

TEST_CASE("Exact propagation, 400 random models with what is not linear in pieces") {
  // Against the same in 97 runs, one after the other, which have other steps. How far the two may be apart
  // follows from a run that starts 1e-8 off.
  constexpr int kLegs = 97;
  constexpr double kMoved = 1e-8;
  int judged = 0;
  for (unsigned seed = 2001; seed <= 2401; ++seed) {
    const RandomModel model = random_model(seed, {.decades = 6.0, .varying = true, .duration = 60.0});
    INFO("seed " << seed);
    int calls = 0;
    ExactOptions options{
        .tolerance = 1e-12, .t_end = model.t_end, .energy_tolerance = 1e-9, .progress = [&](double) {
          return ++calls < kMostCalls;
        }};
    State state = State::initial(model.system), in_legs = state, moved = state;
    const RunSummary run = propagate(model.system, options, state);
    INFO(run.brief_report());
    CHECK(run.ok());
    CHECK(std::abs(run.energy.relative_error()) < 1e-9);
    for (int leg = 0; leg < kLegs; ++leg) {
      ExactOptions part = options;
      part.tolerance = 1e-13;
      part.t_start = model.t_end * leg / kLegs;
      part.t_end = model.t_end * (leg + 1) / kLegs;
      calls = 0;
      CHECK(propagate(model.system, part, in_legs).ok());
    }
    moved.z.array() += kMoved * moved.z.lpNorm<Eigen::Infinity>();
    moved.v *= 1.0 + kMoved;
    calls = 0;
    CHECK(propagate(model.system, options, moved).ok());
    const auto difference = [&](const State& s) {
      return std::max((s.z - state.z).lpNorm<Eigen::Infinity>() / state.z.lpNorm<Eigen::Infinity>(),
                      (s.v - state.v).lpNorm<Eigen::Infinity>() / state.v.lpNorm<Eigen::Infinity>());
    };
    const double amplified = std::max(1.0, difference(moved) / kMoved);
    INFO("amplified " << amplified << ", differs by " << difference(in_legs));
    if (amplified > 1e4) continue;
    ++judged;
    CHECK(difference(in_legs) < 1e-9 * amplified);
  }
  CHECK(judged > 300);
}
