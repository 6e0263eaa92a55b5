#pragma once
/// CurveCells: the smooth curves S and G of a KnottedLoad as polynomials of the angle, each about the middle of a cell.
///
/// Cells are so narrow that the last two of 16 Chebyshev coefficients are below 1e-14 of the largest, or 1024 a
/// revolution at most; they reach nearly twice as far as half their width, so that a step's angles rarely leave one.
#include <drev/core/law/knotted_load.hpp>

#include <array>
#include <memory>
#include <vector>

namespace drev {

class CurveCells {
 public:
  static constexpr int kTerms = 16;
  struct Cell {
    double centre = 0.0;                              ///< rad from the curves' start, within the first period
    std::array<double, kTerms> factor{}, by_speed{};  ///< S and G, of (theta - centre)^k
  };
  /// load.turns() > 0.
  explicit CurveCells(const KnottedLoad& load);
  /// The same curves further on: S(theta - by) and G(theta - by). They share the cells.
  CurveCells shifted(double by) const;

  struct Place {
    const Cell* cell;
    double distance;  ///< of the angle from its centre
  };
  Place at(double angle) const;
  /// How far from its centre a cell's polynomials hold [rad].
  double reach() const { return reach_; }
  /// S, G and their slopes at a place.
  struct Values {
    double factor = 0.0, factor_slope = 0.0, by_speed = 0.0, by_speed_slope = 0.0;
  };
  static Values values(const Place& place);

 private:
  bool fill(const KnottedLoad& load, std::size_t count);
  double period_ = 0.0, width_ = 0.0, reach_ = 0.0, start_ = 0.0;
  std::shared_ptr<const std::vector<Cell>> cells_;
};

}  // namespace drev
