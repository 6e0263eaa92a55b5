#pragma once
/// OrderTracking: amplitudes and phases of orders over a run whose speed changes, window by window of an angle phi: the
/// nominal angle of the reference shaft, or, where nothing turns nominally, the actual angle of a node.
///
///   A_o exp(i p_o) = 2 int w(phi) y exp(-i o phi) dphi / int w dphi,   w = sin^2(pi (phi - phi_a) / W)
///
/// y is about A_o cos(o phi + p_o) there; phi is counted in the sense in which the shaft turns at the start; of an
/// actual angle that starts at rest in the sense in which it has turned kBegun turns, where the first window begins. Where a
/// shaft rocks back its way counts against itself: the integrals are those over the angle. Windows of W, each beginning half of one after the last (Hann's window in the angle). An order that the
/// channel holds with a constant amplitude comes out exactly; another order o' leaks nothing where (o - o') W /
/// (2 pi) is a whole number of at least 2. A resonance that swings freely is none of the orders, and is left
/// out as far as it differs from them. Bandwidth (equivalent noise bandwidth of the window): 1.5 / turns orders;
/// orders are told apart from 2 / turns on (kBandwidth, kResolution). An amplitude that changes inside a window comes out as its mean there.
///
/// Where the angle is an actual one, angles and speeds of nodes grow with it, and would leak into every order. Of these
/// the order is what a parabola of the time beside it leaves, a_0 + a_1 t + a_2 t^2 + A_o cos(o phi + p_o), by least squares
/// with the window's weights: the vibration about the mean motion.
///
/// Source: K. R. Fyfe, E. D. S. Munck, Analysis of computed order tracking, Mechanical Systems and Signal
/// Processing 11(2), 1997, doi:10.1006/mssp.1996.0056. Deviation: the angle is known, so that nothing is
/// resampled; the integral is the trapezoidal rule over the points of the run. Of more than kMostWindows windows every second
/// one is left out, and those that follow begin twice as far apart.
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
  std::string shaft;  ///< node whose actual angle orders are of; empty: nominal angle of the reference shaft
  std::vector<double> orders;  ///< a turn of it
  std::vector<double> time;    ///< s, middle of each whole window
  std::vector<double> speed;   ///< rad/s, mean of phi' in its sense over it, weighted as the window
  double first_speed = 0.0;    ///< rad/s, where the run begins
  /// [channel][order][window], in the channel's unit.
  std::vector<std::vector<std::vector<double>>> amplitude;
  std::vector<std::vector<std::vector<double>>> phase;  ///< p_o [rad], -pi to pi
};

class OrderTracking final : public Observer {
 public:
  /// Orders times the turns of a window: equivalent noise bandwidth; the least distance at which orders do not leak.
  static constexpr double kBandwidth = 1.5, kResolution = 2.0;
  static constexpr double kBegun = 0.1;
  static constexpr std::size_t kMostWindows = 1600;
  /// channels: unknown ones throw ModelError. orders: > 0. turns: of the reference shaft in a window, > 0.
  /// own_times: asks for points close enough for the highest order; false: for methods whose steps that would
  /// cut, the ends of steps are the points. shaft: as OrderTracks::shaft; unknown: throws ModelError.
  OrderTracking(const System& system, const std::vector<std::string>& channels, std::vector<double> orders,
                double turns, bool own_times, const std::string& shaft = {});
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  double next_stop(double t) const override;
  bool needs_acceleration() const override;

  const OrderTracks& tracks() const { return tracks_; }

 private:
  using Complex = std::complex<double>;
  struct Window {
    double begin = 0.0;                              ///< rad turned
    double weights = 0.0, time = 0.0, moment = 0.0;  ///< int w dphi, int w dt, int w t dt
    std::vector<Complex> sums;                       ///< of each channel and order
    // int w t^k dphi; of each channel that grows int w t^k y dphi, and of each order int w t^k exp(-i o phi) dphi; t since t_0.
    double t_0 = 0.0;
    std::array<double, 5> moments{};
    std::vector<std::array<double, 3>> trends;
    std::vector<std::array<Complex, 3>> waves;
  };
  void add_trends(Window& window, double w0, double w1, double t_before, double dphi);
  Complex beside_trend(const Window& window, std::size_t trend, std::size_t order, Complex sum) const;
  void open(double begin);
  void close(const Window& window);
  void thin();
  void look(const Assembler& assembler, const EvaluatedState& point);
  /// Angle and speed that orders are of [rad, rad/s].
  std::pair<double, double> turning(const Assembler& assembler, const EvaluatedState& point) const;
  bool has_begun(double angle);

  std::vector<Channel> channels_;
  std::vector<int> trend_of_;  // of each channel, its place in Window::trends; -1: it does not grow
  std::size_t trends_ = 0;
  double width_, spacing_, highest_ = 0.0;
  bool own_times_;
  int node_ = -1;       // whose actual angle; -1: nominal
  double sense_ = 1.0;  // of an actual angle; 0: not known yet
  double first_angle_ = 0.0, first_time_ = 0.0;
  double next_ = 0.0;  // begin of the next window [rad turned]
  double angle_ = 0.0, turned_ = 0.0, time_ = 0.0, interval_ = 0.0;
  std::vector<double> values_, last_values_;
  std::vector<Complex> turns_, last_turns_;  // exp(-i o phi)
  std::vector<Window> windows_;
  OrderTracks tracks_;
};

}  // namespace drev
