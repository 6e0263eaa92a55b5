#pragma once
/// HarmonicCells: a sum of harmonics as polynomials of its angle, each about the middle of a cell.
///
/// With o the highest order, a cell is left at |theta - centre| = 1.1/o; its Taylor polynomial of 24 terms is off by
/// at most 2.2^24/24! = 3e-16 of the sum of the amplitudes as far as 2.2/o. Cells are made when an
/// angle first enters them and kept where the orders have a common period of at most 8 revolutions.
#include <drev/core/law/harmonic_load.hpp>

#include <array>
#include <vector>

namespace drev {

class HarmonicCells {
 public:
  static constexpr int kTerms = 24;
  struct Cell {
    double centre = 0.0;                    ///< rad, of the period's first turn
    std::array<double, kTerms> terms = {};  ///< of (theta - centre)^k
    bool made = false;
  };

  explicit HarmonicCells(const LoadOrders& orders);
  /// The cell of an angle [rad], and the angle less its centre.
  struct Place {
    const Cell* cell;
    double distance;
  };
  Place at(double angle);
  /// How far from its centre a cell's polynomial holds [rad].
  double reach() const { return reach_; }
  /// Torque and slope there.
  static LoadResponse value(const Place& place);

 private:
  void make(double centre, Cell& cell) const;

  LoadOrders orders_;
  double reach_ = 0.0, width_ = 0.0;
  double turns_ = 0.0;  // turns of the common period; 0: there is none
  std::vector<Cell> cells_;
};

}  // namespace drev
