#pragma once
/// The camshaft as other programs see it (peers/chain.hpp), drev's side of the comparison, and how
/// both are measured.
///
/// Error: largest error of the free end's angle over a horizon, over its peak there, at the ends of
/// the program's own steps (no interpolation), of a run of drev at tolerance 1e-14 that stops at
/// just these times. check_reference() holds that run against RK5 in extended precision.
/// Time: processor time over 5 s simulated, set-up included, nothing observed.
#include <drev/core/assembler.hpp>
#include <drev/core/element.hpp>
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>
#include <drev/models/ready_made.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>

#include "models/camshaft/camshaft_data.hpp"
#include "tests/benchmark/peers/lean_rk5.hpp"
#include "tests/catch.hpp"

namespace drev::benchmark {

using peers::Chain;
using peers::Sample;

/// tau = amplitude pulse((theta + phase)/width), pulse(w) = 5.8 w (1 - w^2)^6 for |w| < 1, else 0;
/// theta + phase taken to half a turn either side. theta: actual angle.
class PulseTorque final : public Element, public Load {
 public:
  struct Params {
    double amplitude = 0.0;  ///< N m
    double phase = 0.0;      ///< rad
    double width = 1.0;      ///< half of the pulse [rad], < pi
  };
  explicit PulseTorque(Params params) : p_(params) {}
  std::string_view type() const override { return "pulse torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override { check.positive("width", p_.width, "rad"); }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override {
    ++calls;
    const double turn = (in.nominal_angle + in.deviation + p_.phase) / kTwoPi;
    const double w = kTwoPi * (turn - std::floor(turn + 0.5)) / p_.width;
    return {.torque = p_.amplitude * peers::pulse(w),
            .dtorque_dangle = p_.amplitude * peers::pulse_slope(w) / p_.width};
  }

  static inline long calls = 0;  ///< of evaluate(), of all

 private:
  Params p_;
};

struct Problem {
  std::string name;
  System system;
  Chain chain;
  std::vector<double> horizons;  ///< s, ascending
  double duration = 5.0;         ///< s

  double horizon() const { return horizons.back(); }
};

/// Pulses about as high, wide and late as the three cams' torques.
struct Cam {
  const char* name;
  PulseTorque::Params pulse;
};
constexpr Cam kCams[] = {
    {"fuel", {-1.0e4, -1.59, 1.94}}, {"exhaust", {-1.4e3, -3.32, 1.17}}, {"inlet", {-2.2e3, -5.18, 1.57}}};

inline double firing_phase(int cylinder) {
  const auto order = default_firing_order(9);
  const auto place = std::find(order.begin(), order.end(), cylinder) - order.begin();
  return -kTwoPi * static_cast<double>(place) / 9.0;
}

/// The model case's model with pulses in place of its cams.
inline Model with_pulses(const Model& from) {
  Model m("camshaft with smooth pulses");
  for (const std::string& node : from.node_names()) m.add_node(node);
  for (const ElementInstance& p : from.element_instances())
    if (!p.name.starts_with("cam_")) m.add(p.name, p.nodes, p.element);
  for (int k = 1; k <= 9; ++k)
    for (const Cam& cam : kCams) {
      PulseTorque::Params pulse = cam.pulse;
      pulse.phase += firing_phase(k);
      const std::string node = cam.name + ("_" + std::to_string(k));
      m.add<PulseTorque>("cam_" + node, {node}, pulse);
    }
  for (const Model::Prescription& p : from.prescriptions()) m.constant_speed(p.node, *p.omega);
  return m;
}

/// Copies what the system holds; throws where the chain cannot express it.
inline Chain make_chain(const System& s, bool smooth) {
  Chain c;
  c.n = s.size();
  c.smooth = smooth;
  c.end = s.node_map(s.node("end")).unknown;
  const auto need = [](bool ok, const char* what) {
    if (!ok) throw SolverError(std::string("the peers' chain has no ") + what);
  };
  need(c.n <= peers::kRows && s.mass_is_diagonal() && s.damping_is_diagonal(), "such matrices");
  const auto row = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<double> inertia(row(c.n));
  for (int i = 0; i < c.n; ++i) inertia[row(i)] = s.mass_values()[s.diagonal_slots()[row(i)]];
  std::copy(inertia.begin(), inertia.end(), c.inertia);
  const SparseMatrix& pattern = s.pattern();
  for (int j = 0; j < c.n; ++j)
    for (int slot = pattern.outerIndexPtr()[j]; slot < pattern.outerIndexPtr()[j + 1]; ++slot) {
      const int i = pattern.innerIndexPtr()[slot];
      const double k = s.stiffness_values()[slot] / inertia[row(i)];
      need(std::abs(i - j) <= 1 || k == 0.0, "shaft but a straight one");
      if (i == j) c.main[i] = k, c.damping[i] = s.damping_values()[slot] / inertia[row(i)];
      if (i == j + 1) c.low[i] = k;
      if (i == j - 1) c.up[i] = k;
    }
  for (const ScalarTerm& term : s.scalars()) {
    const auto gap = term.force->gap();
    need(gap && term.u.size() + term.z.size() == 2 && term.force->closed_damping() == 0.0, "such law");
    peers::Mesh m{.k = term.force->closed_stiffness(), .half_gap = gap->high};
    m.a = term.z[0].index, m.arm_a = term.z[0].coeff;
    m.push_a = m.arm_a / inertia[row(m.a)];
    if (term.z.size() > 1) {
      m.b = term.z[1].index, m.arm_b = term.z[1].coeff;
      m.push_b = m.arm_b / inertia[row(m.b)];
    }
    c.meshes.push_back(m);
  }
  const CamTorques& cams = cam_torques();
  const PeriodicTable* tables[] = {&cams.fuel, &cams.exhaust, &cams.inlet};
  c.knots = static_cast<int>(cams.fuel.values().size());
  for (const PeriodicTable* table : tables)
    for (std::size_t i = 0; i < row(c.knots); ++i) {
      c.value.push_back(table->values()[i]);
      c.rise.push_back(table->values()[(i + 1) % row(c.knots)] - table->values()[i]);
    }
  const double reference_speed = s.reference()->at(0.0).rate;
  for (const LoadTerm& term : s.loads()) {
    const int i = s.node_map(term.node).unknown;
    const std::string& node = s.node_names()[row(term.node)];
    c.omega = s.ratio(term.node) * reference_speed;
    const int cylinder = std::stoi(node.substr(node.find('_') + 1));
    for (int k = 0; k < 3; ++k) {
      if (!node.starts_with(kCams[k].name)) continue;
      const PulseTorque::Params& pulse = kCams[k].pulse;
      double phase = firing_phase(cylinder) + (smooth ? pulse.phase : 0.0);
      phase -= kTwoPi * std::floor(phase / kTwoPi);
      if (kTwoPi - phase < 1e-9) phase = 0.0;
      if (smooth && phase >= 0.5 * kTwoPi) phase -= kTwoPi;  // one wrap is enough for each
      c.phase[i] = phase;
      c.load[i] = (smooth ? pulse.amplitude : 1.0) / inertia[row(i)];
      c.inverse_width[i] = 1.0 / pulse.width;
      c.table[i] = k * c.knots;
    }
  }
  return c;
}

/// Largest relative difference of the chain's accelerations and drev's, in contact, over a turn.
inline double difference(const System& s, const Chain& c) {
  Assembler assembler(s);
  Vector z(s.size()), v(s.size()), p, kz, cv, f(s.size()), a(s.size());
  for (int i = 0; i < s.size(); ++i) {
    z[i] = 0.01 * std::sin(1.0 + 3.7 * i);
    v[i] = std::cos(2.3 * i);
  }
  double scale = 0.0, worst = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double t = 1.2345 + k * 0.01 * kTwoPi / c.omega;
    assembler.set_time(t);
    assembler.external(z, v, p);
    assembler.multiply_stiffness(z, kz);
    assembler.multiply_damping(v, cv);
    f.setZero();
    assembler.add_scalar_forces(z, v, f);
    f = p - kz - cv - f;
    peers::accelerations<double>(c, t, z.data(), v.data(), nullptr, a.data());
    for (int i = 0; i < s.size(); ++i) {
      const double exact = f[i] / s.mass_values()[s.diagonal_slots()[static_cast<std::size_t>(i)]];
      scale = std::max(scale, std::abs(exact));
      worst = std::max(worst, std::abs(exact - a[i]));
    }
  }
  return worst / scale;
}

inline Problem make_problem(const std::string& drive, bool smooth) {
  Parameters parameters("camshaft", camshaft_entry().parameters);
  parameters.set("drive", drive);
  const ModelCase model_case = camshaft_entry().build(parameters);
  System system = (smooth ? with_pulses(model_case.model) : model_case.model).build();
  Chain chain = make_chain(system, smooth);
  const double off = difference(system, chain);
  REQUIRE(off < 1e-12);
  return {.name = "camshaft, " + drive + (smooth ? ", smooth pulses" : ", tables"),
          .system = std::move(system),
          .chain = std::move(chain),
          .horizons = drive == "gears" ? std::vector{0.1, 0.2} : std::vector{1.0}};
}

/// Samples at given times (the run stops there), or at step ends past evenly spaced times.
class EndAngle final : public Observer {
 public:
  EndAngle(const Problem& p, std::vector<double> times)
      : end_(p.chain.end), sampler_(p.horizon(), 1), times_(std::move(times)) {}
  EndAngle(const Problem& p, int count) : end_(p.chain.end), sampler_(p.horizon(), count) {}

  void start(const Assembler&, const EvaluatedState&) override {}
  void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override {
    const double t = to.state.t, angle = to.state.z[end_];
    if (times_.empty()) return sampler_.see(t, angle, samples);
    while (next_ < times_.size() && t >= times_[next_] - 1e-13) samples.push_back({times_[next_++], angle});
  }
  double next_stop(double t) const override {
    const auto next = std::upper_bound(times_.begin(), times_.end(), t + 1e-13);
    return next == times_.end() ? std::numeric_limits<double>::infinity() : *next;
  }
  std::vector<Sample> samples;

 private:
  int end_;
  peers::Sampler sampler_;
  std::vector<double> times_;
  std::size_t next_ = 0;
};

constexpr int kSamples = 1000;
constexpr double kReferenceTolerance = 1e-14;

/// Largest error over each horizon, over the peak there.
inline std::vector<double> errors(const Problem& p, const std::vector<Sample>& samples) {
  std::vector<double> times;
  for (const Sample& s : samples)
    if (s.t <= p.horizon()) times.push_back(s.t);
  EndAngle reference(p, times);
  propagate(p.system, {.tolerance = kReferenceTolerance, .t_end = p.horizon()}, {&reference});
  std::vector<double> result;
  for (const double horizon : p.horizons) {
    double worst = 0.0, peak = 0.0;
    for (std::size_t i = 0; i < reference.samples.size() && times[i] <= horizon; ++i) {
      const double exact = reference.samples[i].angle, error = samples[i].angle - exact;
      worst = std::max(worst, std::isfinite(error) ? std::abs(error) : 1e9);
      peak = std::max(peak, std::abs(exact));
    }
    result.push_back(samples.empty() ? 1e9 : worst / peak);
  }
  return result;
}

inline bool no_larger(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] <= b[i])) return false;
  return true;
}

inline double median(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  return x[x.size() / 2];
}

inline std::string join(const std::vector<double>& x) {
  std::string text;
  char part[32];
  for (const double value : x) {
    std::snprintf(part, sizeof part, "%s%.1e", text.empty() ? "" : ", ", value);
    text += part;
  }
  return text;
}

/// drev on one problem: error and time by tolerance, each found once.
class Drev {
 public:
  explicit Drev(const Problem& p) : p_(p) {}

  double seconds(double tolerance) const {
    const std::clock_t start = std::clock();
    const RunSummary r =
        propagate(p_.system, {.tolerance = tolerance, .t_end = p_.duration, .energy_tolerance = 1.0});
    const double time = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    INFO(r.reason);
    CHECK(r.ok());
    return time;
  }
  const std::vector<double>& error(double tolerance) {
    auto& known = errors_[tolerance];
    if (!known.empty()) return known;
    EndAngle end(p_, kSamples);
    propagate(p_.system, {.tolerance = tolerance, .t_end = p_.horizon(), .energy_tolerance = 1.0}, {&end});
    return known = errors(p_, end.samples);
  }
  /// The loosest of 1e-2, 3e-3, 1e-3, ... whose error is no larger, and whose tighter neighbour's is
  /// not either (or none: 0).
  double loosest(const std::vector<double>& limit) {
    const auto tolerance = [](int i) { return (i % 2 ? 3.0 : 1.0) * std::pow(10.0, -2 - (i + 1) / 2); };
    for (int i = 0; i < 22; ++i)
      if (no_larger(error(tolerance(i)), limit) && no_larger(error(tolerance(i + 1)), limit))
        return tolerance(i);
    return 0.0;
  }

 private:
  const Problem& p_;
  std::map<double, std::vector<double>> errors_;
};

/// A line that scripts/peers.sh puts into its table: processor seconds of drev and of the peer.
inline void report(const std::string& problem, const std::string& peer, double own, double other,
                   const std::string& remark) {
  const double ratio = other / own;
  std::printf("ratio| %s | %s | %.3g | %.3g | %.*f | %s |\n", problem.c_str(), peer.c_str(), own, other,
              ratio < 10.0    ? 3
              : ratio < 100.0 ? 1
                              : 0,
              ratio, remark.c_str());
  std::fflush(stdout);
}

struct Row {
  std::string what;
  double rtol = 0.0;
  double ratio = 0.0;
};

inline void print_header(const Problem& p) {
  std::printf("\n%s: %d unknowns, %.0f s; errors over 0 to", p.name.c_str(), p.system.size(), p.duration);
  for (const double h : p.horizons) std::printf(" %.1f", h);
  std::printf(
      " s\n| program | rtol | time [s] | steps | evaluations | changes | error | drev's tolerance "
      "| time "
      "[s] | error | ratio |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
}

/// One program at one rtol beside drev: `run(t_end, samples)`. Times by turns, medians of `runs`.
template <class Run>
Row compare(const Problem& p, Drev& drev, const std::string& what, double rtol, int runs, const Run& run) {
  const std::vector<double> peer_error = errors(p, run(p.horizon(), kSamples).samples);
  const double tolerance = drev.loosest(peer_error);
  std::vector<double> peer, own;
  peers::PeerRun last;
  for (int i = 0; i < runs; ++i) {
    last = run(p.duration, 0);
    peer.push_back(last.seconds);
    if (tolerance > 0.0) own.push_back(drev.seconds(tolerance));
    if (last.t_end < p.duration) break;
  }
  std::printf("| %s | %.0e | %.4f | %ld | %ld | %ld | %s |", what.c_str(), rtol, median(peer), last.steps,
              last.evaluations, last.changes, join(peer_error).c_str());
  Row row{what, rtol, own.empty() ? 0.0 : median(peer) / median(own)};
  if (last.t_end < p.duration) {
    std::printf(" cut at %.2f s simulated |||", last.t_end);
    row.ratio = 0.0;
  } else if (own.empty()) {
    std::printf(" none is as exact |||");
  } else {
    std::printf(" %.0e | %.4f | %s |", tolerance, median(own), join(drev.error(tolerance)).c_str());
  }
  if (row.ratio > 0.0)
    std::printf(" %.2f |\n", row.ratio);
  else
    std::printf(" |\n");
  if (row.ratio > 0.0)
    report(to_text(p.duration) + " s, " + p.name, what + ", rtol " + to_text(rtol), median(own), median(peer),
           "errors " + join(drev.error(tolerance)) + " beside " + join(peer_error));
  std::fflush(stdout);
  return row;
}

/// The smallest ratio at each rtol.
inline void print_best(const std::vector<Row>& rows) {
  std::map<double, Row, std::greater<>> best;
  for (const Row& row : rows)
    if (row.ratio > 0.0 && (!best.count(row.rtol) || row.ratio < best[row.rtol].ratio)) best[row.rtol] = row;
  for (const auto& [rtol, row] : best)
    std::printf("best at rtol %.0e: %s, drev is %.1f times as fast\n", rtol, row.what.c_str(), row.ratio);
}

/// drev's reference beside RK5 in extended precision, with every contact change and knot located.
inline void check_reference(const Problem& p) {
  // In the gear drive the motion amplifies what is left of it.
  const peers::LeanOptions tight{.rtol = p.chain.meshes.empty() ? 1e-14 : 1e-15,
                                 .t_end = p.horizon(),
                                 .knots = !p.chain.smooth,
                                 .samples = kSamples};
  const peers::PeerRun r = run_long_rk5(p.chain, tight);
  const std::vector<double> off = errors(p, r.samples);
  std::printf(
      "reference (tolerance %.0e) beside RK5 in extended precision (rtol %.0e, %ld steps, %.0f s): "
      "%s\n",
      kReferenceTolerance, tight.rtol, r.steps, r.seconds, join(off).c_str());
  CHECK(r.t_end == p.horizon());
  for (const double e : off) CHECK(e < 1e-7);  // an ulp in one stiffness: 3e-9 after 0.2 s of rattle
}

}  // namespace drev::benchmark
