#pragma once
/// ExpandedLoads: smooth loads whose torque along a step follows as a power series from that of the angle, by products:
///
///   p = P(x) + G(x) w^2,    x = theta - theta_0 = sum_{k>0} x_k s^k,    w = x'/h
///   P(x)_m = sum_j P_j [x^j]_m,    [x^j]_m = sum_{i=1}^{m-j+1} x_i [x^{j-1}]_{m-i}
///
/// P_j, G_j: the load about the angle at the step's start, of a sum of harmonics (harmonic_cells.hpp) or of a load that says
/// its knots (KnottedLoad), which is continued analytically behind the knots of its piece: LoadSeries adds what the piece
/// there differs. Torques take no passes so. Eight loads at once, a lane each; the tangent at the start is in stiffness and
/// damping. Source: A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM, 2008, chapter 13.
#include <drev/core/law/knotted_load.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/law/curve_cells.hpp"
#include "solvers/exact/harmonic_cells.hpp"
#include "solvers/exact/tangent_load.hpp"

namespace drev {

class ExpandedLoads final : public TermForces {
 public:
  explicit ExpandedLoads(const System& system) : system_(system) {}
  /// The load says its harmonics, or its knots and curves of a common period.
  static bool takes(const System& system, const LoadTerm& term);
  /// The train turns, at constant nominal speed.
  static bool is_constant(const MotionPoint& nominal) {
    return nominal.rate != 0.0 && nominal.acceleration == 0.0;
  }
  /// Whether a load's cubics hold then, or else: they are those of a nominal speed.
  static bool holds(const System& system, const LoadTerm& term, bool constant);
  void add(const LoadTerm& term, TaylorSeries& series);

  struct Load : TangentLoad, KnottedPlace {  // of knots: P is a cubic times a curve
    using TangentLoad::TangentLoad;
    std::shared_ptr<HarmonicCells> cells = {};      // of a sum of harmonics
    std::shared_ptr<const CurveCells> curves = {};  // cells of a load that says its knots
    std::vector<Entry> gain;                        // M^-1 b over unknowns
    bool acts = false;                              // it holds under the nominal motion at hand
  };
  std::vector<Load>& loads() { return loads_; }
  const std::vector<Load>& loads() const { return loads_; }
  /// Some load acts under the nominal motion at hand.
  bool active() const override { return !groups_.empty(); }
  bool sweeps() const override { return true; }
  /// Whether some load that acts says knots.
  bool knotted() const { return knotted_; }

  /// Finds where the loads stand at a state, at the assembler's time.
  void move(const Assembler& assembler, const Vector& z, const Vector& v);
  void move_as(const ExpandedLoads& other);
  /// The piece ahead of a knot in the direction of the angle, where the load stands.
  void look_up(Load& load, double direction) {
    load.KnottedPlace::look_up(load.angle, direction, load.ratio * nominal_rate_);
  }
  /// Adds the tangents over a step of h seconds, and their slopes, to the series.
  void add_to(TaylorSeries& series, double h, const std::array<double, 3>& phi);
  /// The part of the step over which the loads' polynomials hold, <= 1.
  double part_held() const { return part_held_; }
  double add(const TaylorSeries& series, int k, double factor, double* term) override;
  void note_left_out(const TaylorSeries& series, int k, double factor,
                     TaylorSeries::Norm& most) const override;
  /// Whether, in the expanded series, an angle came further than was allowed for: the step is to be expanded again.
  bool came_further(const TaylorSeries& series);

  /// The polynomial sum_q d_q (theta - knot)^q, q = 1 ... size, by which a load differs behind a knot, where `next` follows on
  /// `piece` about an angle, and the turn behind the knot is at most `turn`. None: it jumps there.
  std::optional<std::span<const double>> behind_knot(const Load& load, const CubicPiece& piece, double about,
                                                     double knot, const CubicPiece& next, double turn);
  /// Bound of how much the loads' slopes, and their slopes by speed, change of the accelerations of rows over the step.
  struct SlopeChange {
    double by_angle = 0.0, by_speed = 0.0;  ///< 1/s^2, 1/s
  };
  SlopeChange slope_change(const TaylorSeries& series) const;
  /// Puts the slopes at s of the step in place of those at its start, as a sweep to there asks for; and those back.
  void use_slopes(TaylorSeries& series, double s);
  void return_slopes(TaylorSeries& series);

  /// Work on the unknowns from 0 to s along the series [J].
  double work(const TaylorSeries& series, double s);
  /// Change of work() by the motion that a sweep adds up to s [J]; called after work().
  double swept_work(const TaylorSeries& series, double s) const;

  static constexpr int kTerms = 24;  ///< of P and G in x at most
  static_assert(HarmonicCells::kTerms <= kTerms && CurveCells::kTerms + 3 <= kTerms);

 private:
  static constexpr std::size_t kOrders = TaylorSeries::kMaxDegree + 2;  // terms of a series
  using TermLanes = std::array<double, std::size_t{kTerms} * kLanes>;
  using SeriesLanes = std::array<double, kOrders * kLanes>;
  using OneLanes = std::array<double, kLanes>;
  struct Group {
    int count = 0;
    std::array<int, kLanes> load{};
    // Whose terms are in the lanes.
    std::array<const void*, kLanes> cell{};
    OneLanes centre{};
    int cell_terms = 0, top = 0;  // terms of the cells; power of x up to which P and G matter in this step
    bool speeds = false;          // G is not 0
    OneLanes distance{}, from_about{}, speed{}, slope{}, speed_slope{};
    OneLanes more_slope{}, more_by_speed{};  // use_slopes()
    OneLanes reach{},
        came{};  // rad that x may come in the step; rad/s that it came on the way in the last one
    TermLanes factor{}, by_speed{};  // terms of the cells
    std::array<double, std::size_t{4} * kLanes> cubic{};
    TermLanes p{}, g{};
    // Series of the row's motion, of x and w; of G(x) and w^2; and of the powers of x from the second on.
    SeriesLanes along{}, x{}, rate{}, curve{}, square{};
    SeriesLanes rest{};  // what the torque differs from its tangent
    std::vector<double> powers;
  };
  struct Start;
  struct Term;
  struct LeftOut;
  struct Work;
  void find_groups(const MotionPoint& nominal);
  void place(Load& load, Group& group, std::size_t lane);
  void gather(Group& group, const TaylorSeries& series, int m) const;
  /// sum terms[k] s^k of a lane, and its first two derivatives.
  struct Values {
    double value = 0.0, slope = 0.0, bend = 0.0;
  };
  static Values values(const double* terms, int degree, std::size_t lane, double s);
  double given_work(const Group& group, std::size_t lane, const Load& l, const TaylorSeries& series,
                    double s) const;

  const System& system_;
  std::vector<Load> loads_;
  std::vector<Group> groups_;
  bool grouped_ = false, constant_ = false, knotted_ = false;
  double h_ = 0.0, nominal_rate_ = 0.0, part_held_ = 1.0;
  std::array<double, 3> phi_{};
  std::vector<double> difference_;
};

}  // namespace drev
