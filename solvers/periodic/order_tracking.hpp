#pragma once
/// OrderTracking: amplitudes and phases of orders over a run whose speed changes, in windows of an angle phi.
/// phi is the nominal angle of the reference shaft or, where nothing turns nominally, the actual angle of a
/// node.
///
///   int w (a_0 + A_o cos(o phi + p_o) - y)^2 dphi  least,   w = sin^2(pi (phi - phi_a) / W)
///
/// which is A_o exp(i p_o) = 2 int w y exp(-i o phi) dphi / int w dphi where o W / (2 pi) is an integer of at least 2; an
/// order below, as of a shaft geared down, would hold a part of the mean. phi is counted in the sense in which the shaft turns at the
/// start; behind a reversal of a nominal angle in the other sense, and windows that hold the reversal are left out. An actual
/// angle that starts at rest is counted in the sense in which it has first turned by kBegun
/// turns, where the first window begins. Where its shaft turns back, an actual angle decreases: the integrals are
/// those over the angle. Windows have the length W, and each begins half a window after the last one (Hann
/// window in the angle). An order that the channel contains with a constant amplitude is found exactly beside a
/// constant mean; another order o' does not leak into it where (o - o') W / (2 pi) is an integer of at least 2. A freely
/// oscillating resonance is not one of the orders and is left out as far as its frequency differs from
/// theirs. Bandwidth (equivalent noise bandwidth of the window): 1.5 / turns orders; orders are resolved from
/// a distance of 2 / turns on (kBandwidth, kResolution). If an amplitude changes inside a window, its mean
/// over the window is found.
///
/// Where a part floats freely or the angle is an actual one, angles and speeds of nodes grow and would leak into every
/// order. In these channels the order is fitted beside a parabola in time, a_0 + a_1 t + a_2 t^2: it is the vibration about
/// the mean motion.
///
/// Source: K. R. Fyfe, E. D. S. Munck, Analysis of computed order tracking, Mechanical Systems and Signal
/// Processing 11(2), 1997, doi:10.1006/mssp.1996.0056. Deviation from the source: the angle is known, so that
/// nothing is resampled; the integrals are taken by the trapezoidal rule over the points of the run. If there
/// are more than kMostWindows windows, every second one is dropped, and later windows begin twice as far
/// apart.
#include <drev/core/channel.hpp>
#include <drev/solvers/run/observer.hpp>

#include <array>
#include <complex>
#include <string>
#include <utility>
#include <vector>

namespace drev {

struct OrderTracks {
  std::vector<std::string> channels, units;
  std::string shaft;  ///< node whose actual angle is phi; empty: nominal angle of the reference shaft
  std::vector<double> orders;  ///< orders per turn of phi
  std::vector<double> time;    ///< middle of each complete window [s]
  std::vector<double>
      speed;  ///< mean of phi' over each window, with its sign and the window's weights [rad/s]
  double first_speed = 0.0;  ///< phi' at the start of the run [rad/s]
  /// Amplitudes A_o in the channel's unit: [channel][order][window].
  std::vector<std::vector<std::vector<double>>> amplitude;
  std::vector<std::vector<std::vector<double>>> phase;  ///< phases p_o [rad], -pi to pi
};

class OrderTracking final : public Observer {
 public:
  /// Both times the turns of a window: equivalent noise bandwidth [orders]; smallest distance at which orders
  /// do not leak into each other [orders].
  static constexpr double kBandwidth = 1.5, kResolution = 2.0;
  static constexpr double kBegun = 0.1;  ///< turns of an actual angle at which its first window begins
  static constexpr std::size_t kMostWindows = 1600;
  /// channels: unknown ones throw ModelError. orders: > 0. turns: turns of the reference shaft in a window, >
  /// 0. own_times: true: asks for points close enough for the highest order; false: the points are the ends
  /// of steps (for methods whose steps additional points would shorten). shaft: as OrderTracks::shaft;
  /// unknown: throws ModelError.
  OrderTracking(const System& system, const std::vector<std::string>& channels, std::vector<double> orders,
                double turns, bool own_times, const std::string& shaft = {});
  bool fits(const System& system) const override { return are_of(system, channels_); }
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  double next_stop(double t) const override;
  bool needs_acceleration() const override;

  const OrderTracks& tracks() const { return tracks_; }

 private:
  using Complex = std::complex<double>;
  struct Window {
    double begin = 0.0;               ///< angle turned at its begin [rad]
    double time = 0.0, moment = 0.0;  ///< int w dt, int w t dt
    std::vector<Complex> sums;        ///< int w y exp(-i o phi) dphi of channels and orders
    bool reverses = false;            ///< the nominal speed changes its sign in it
    // With t counted from t_0. moments: int w t^k dphi; trends: int w t^k y dphi of each channel;
    // waves: int w t^k exp(-i o phi) dphi of each order; twice: int w exp(-2 i o phi) dphi.
    double t_0 = 0.0;
    std::array<double, 5> moments{};
    std::vector<std::array<double, 3>> trends;
    std::vector<std::array<Complex, 3>> waves;
    std::vector<Complex> twice;
  };
  void add_trends(Window& window, double w0, double w1, double t_before, double dphi);
  void fit(const Window& window, std::size_t order, std::size_t terms);
  void open(double begin);
  void close(const Window& window);
  void thin();
  void look(const Assembler& assembler, const EvaluatedState& point);
  /// The angle phi and its speed [rad, rad/s].
  std::pair<double, double> turning(const Assembler& assembler, const EvaluatedState& point) const;
  bool has_begun(double angle);
  bool reverses_to(double rate);

  std::vector<Channel> channels_;
  std::vector<std::size_t> terms_of_;  // powers of the time fitted in each channel: the mean, or a parabola
  std::size_t most_terms_ = 1;
  double width_, spacing_, highest_ = 0.0;
  bool own_times_;
  int node_ = -1;       // node whose actual angle is phi; -1: phi is the nominal angle
  double sense_ = 1.0;  // sense in which an actual angle is counted, 1 or -1; 0: not known yet
  double first_angle_ = 0.0, first_time_ = 0.0;
  double way_ = 0.0;   // sign of the nominal speed when it was last not 0
  double next_ = 0.0;  // angle turned at the begin of the next window [rad]
  double angle_ = 0.0, turned_ = 0.0, time_ = 0.0, interval_ = 0.0;
  std::vector<double> values_, last_values_;
  std::vector<Complex> turns_, last_turns_;  // exp(-i o phi)
  std::vector<Window> windows_;
  OrderTracks tracks_;
};

}  // namespace drev
