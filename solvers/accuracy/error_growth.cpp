#include <drev/core/assembler.hpp>
#include <drev/solvers/accuracy/error_growth.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/accuracy/student.hpp"

namespace drev {

namespace {

constexpr double kSeparation = 1e-9;  // far above rounding, far below what bends the motion

/// Largest |z| and |v| of a run.
class Scale final : public Observer {
 public:
  void start(const Assembler&, const EvaluatedState& point) override { note(point.state); }
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override { note(to.state); }
  double z() const { return z_ > 0.0 ? z_ : 1.0; }
  double v() const { return v_ > 0.0 ? v_ : 1.0; }
  double of(const Vector& dz, const Vector& dv) const {
    return std::max(dz.cwiseAbs().maxCoeff() / z(), dv.cwiseAbs().maxCoeff() / v());
  }

 private:
  void note(const State& s) {
    z_ = std::max(z_, s.z.cwiseAbs().maxCoeff());
    v_ = std::max(v_, s.v.cwiseAbs().maxCoeff());
  }
  double z_ = 0.0, v_ = 0.0;
};

}  // namespace

State neighbour(const System& system, int i, double z_scale, double v_scale) {
  State state = State::initial(system);
  for (int k = 0; k < system.size(); ++k) {
    state.z[k] += kSeparation * z_scale * std::sin(i * (1.0 + 2.0 * k));
    state.v[k] += kSeparation * v_scale * std::cos(i * (2.0 + 3.0 * k));
  }
  return state;
}

Estimate batch_mean(const std::vector<double>& samples, int batches) {
  const std::size_t n = samples.size(), count = std::min(static_cast<std::size_t>(batches), n);
  if (count < 2)
    return {n == 1 ? samples[0] : 0.0, std::numeric_limits<double>::infinity(), Estimate::Kind::interval};
  std::vector<double> means;
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t begin = b * n / count, end = (b + 1) * n / count;
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += samples[i];
    means.push_back(sum / static_cast<double>(end - begin));
  }
  double mean = 0.0, squares = 0.0;
  const double k = static_cast<double>(count);
  for (const double m : means) mean += m / k;
  for (const double m : means) squares += (m - mean) * (m - mean);
  return {mean, student_95(k - 1.0) * std::sqrt(squares / (k - 1.0) / k), Estimate::Kind::interval};
}

double ErrorGrowth::time_of(double factor) const {
  for (std::size_t k = 0; k < t.size(); ++k)
    if (growth[k] > factor) return t[k];
  return std::numeric_limits<double>::infinity();
}

double ErrorGrowth::factor(double time) const {
  double grown = 1.0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    grown = growth[k];
    if (t[k] >= time) break;
  }
  return grown;
}

ErrorGrowth measure_error_growth(const System& system, const ErrorGrowthOptions& o) {
  ErrorGrowth result;
  const int n = system.size();
  State base = State::initial(system);
  if (n == 0) return result;
  Method method = o.method;
  long steps = 0;
  double part = 0.0;  // done
  const auto run_piece = [&](State& state, double begin, double end,
                             const std::vector<Observer*>& observers) {
    const MethodRunOptions piece{
        .t_start = begin, .t_end = end, .energy_tolerance = 1e300, .progress = [&](double) {
          return !o.progress || o.progress(part);
        }};
    const RunSummary run = run_method(system, method, piece, state, observers);
    if (!run.ok()) result.status = run.status, result.reason = run.reason;
    steps = run.steps;
    return run.ok();
  };
  Scale scale;
  State whole = base;
  if (!run_piece(whole, 0.0, o.t_end, {&scale})) return result;
  if (method.controlled())
    method = {.name = "sdirk4", .step = o.t_end / (2.0 * static_cast<double>(std::max(steps, 1L)))};
  result.z_scale = scale.z(), result.v_scale = scale.v();
  Vector dz = Vector::Zero(n), dv(n);
  for (int k = 0; k < n; ++k) dv[k] = scale.v() * std::cos(2.0 + 3.0 * k);
  double logarithm = 0.0, largest = 0.0;
  std::vector<double> rates;
  for (int k = 0; k < o.pieces; ++k) {
    part = static_cast<double>(k) / o.pieces;
    if (o.progress && !o.progress(part)) {
      result.status = RunStatus::interrupted;
      result.reason = "interrupted";
      break;
    }
    const double begin = o.t_end * k / o.pieces, end = o.t_end * (k + 1) / o.pieces;
    State other = base;
    if (!run_piece(base, begin, end, {})) break;
    const double size = scale.of(dz, dv);
    dz *= kSeparation / size, dv *= kSeparation / size;
    other.z += dz, other.v += dv;
    if (!run_piece(other, begin, end, {})) break;
    dz = other.z - base.z, dv = other.v - base.v;
    const double separation = scale.of(dz, dv);
    if (!(separation > 0.0)) break;  // everything was forgotten: nothing grows
    const double step = std::log(separation / kSeparation);
    logarithm += step;
    largest = std::max(largest, logarithm);
    rates.push_back(step * o.pieces / o.t_end);
    result.t.push_back(end);
    result.growth.push_back(std::exp(largest));
  }
  const Estimate rate = batch_mean(rates);
  result.rate = rate.value, result.rate_error = rate.error;
  return result;
}

}  // namespace drev
