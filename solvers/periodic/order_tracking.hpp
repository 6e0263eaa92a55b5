#pragma once
/// OrderTracking: amplitudes and phases of orders over a run whose nominal speed changes, window by window of the nominal
/// angle phi of the reference shaft.
///
///   A_o exp(i p_o) = 2 int w(phi) y exp(-i o phi) dphi / int w dphi,   w = sin^2(pi (phi - phi_a) / W)
///
/// y is about A_o cos(o phi + p_o) there; phi is counted in the sense in which the shaft turns at the start.
/// over windows of W, each beginning half of one after the last (Hann's window in the angle). An order that the
/// channel holds with a constant amplitude comes out exactly; another order o' leaks nothing where (o - o') W /
/// (2 pi) is a whole number of at least 2. A resonance that swings freely is none of the orders, and is left
/// out as far as it differs from them. Bandwidth (equivalent noise bandwidth of the window): 1.5 / turns orders;
/// orders are told apart from 2 / turns on (kBandwidth, kResolution). An amplitude that changes inside a window comes out as its mean there.
///
/// Source: K. R. Fyfe, E. D. S. Munck, Analysis of computed order tracking, Mechanical Systems and Signal
/// Processing 11(2), 1997, doi:10.1006/mssp.1996.0056. Deviation: the angle is known, so that nothing is
/// resampled; the integral is the trapezoidal rule over the points of the run.
#include <drev/core/channel.hpp>
#include <drev/solvers/run/observer.hpp>

#include <complex>
#include <string>
#include <vector>

namespace drev {

struct OrderTracks {
  std::vector<std::string> channels, units;
  std::vector<double> orders;  ///< of the reference shaft
  std::vector<double> time;    ///< s, middle of each whole window
  std::vector<double> speed;   ///< rad/s, mean of |phi'| over it, weighted as the window
  /// [channel][order][window], in the channel's unit.
  std::vector<std::vector<std::vector<double>>> amplitude;
  std::vector<std::vector<std::vector<double>>> phase;  ///< p_o [rad], -pi to pi
};

class OrderTracking final : public Observer {
 public:
  /// Orders times the turns of a window: equivalent noise bandwidth; the least distance at which orders do not leak.
  static constexpr double kBandwidth = 1.5, kResolution = 2.0;
  /// channels: unknown ones throw ModelError. orders: > 0. turns: of the reference shaft in a window, > 0.
  /// own_times: asks for points close enough for the highest order; false: for methods whose steps that would
  /// cut, the ends of steps are the points.
  OrderTracking(const System& system, const std::vector<std::string>& channels, std::vector<double> orders,
                double turns, bool own_times);
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
  };
  void open(double begin);
  void close(const Window& window);
  void look(const Assembler& assembler, const EvaluatedState& point);

  std::vector<Channel> channels_;
  double width_, highest_ = 0.0;
  bool own_times_;
  double angle_ = 0.0, turned_ = 0.0, time_ = 0.0, interval_ = 0.0;
  std::vector<double> values_, last_values_;
  std::vector<Complex> turns_, last_turns_;  // exp(-i o phi)
  std::vector<Window> windows_;
  OrderTracks tracks_;
};

}  // namespace drev
