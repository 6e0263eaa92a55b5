#pragma once
/// PiecewiseLaw: a law that is stated by its pieces alone. Force, slopes, stored energy, dissipated power,
/// kinks, gap and closed slopes all follow from them.
///
///   y = y_0 + k x + (c + product x) x_dot       on the piece that holds (piece_at)
///   V = integral of elastic_0 + elastic_k x over x, continuous, 0 at its least
///   dissipated power = (y - elastic_0 - elastic_k x) x_dot
///
/// Each piece is kept about the zero of its elastic force, or the end of its range that is nearest to it, so
/// that small deflections from there keep all their digits. A law may be evaluated at another stiffness s:
///   y = s Y(x, x_dot/s)       Y: the law as stated
#include <drev/core/law/law_piece.hpp>
#include <drev/core/scalar_force.hpp>

#include <optional>
#include <span>
#include <vector>

namespace drev {

class PiecewiseLaw {
 public:
  PiecewiseLaw() = default;  ///< no pieces: not to be evaluated
  explicit PiecewiseLaw(std::vector<LawPiece> pieces);

  bool empty() const { return pieces_.empty(); }
  std::span<const LawPiece> pieces() const { return pieces_; }
  /// The pieces of s Y(x, x_dot/s), s > 0.
  std::vector<LawPiece> scaled(double s) const;
  /// Where bounds in x alone stand, ascending.
  std::span<const double> kinks() const {
    return edges_.empty() ? std::span<const double>() : std::span(edges_).first(edges_.size() - 1);
  }
  /// The range of x without elastic force, for a law that has elastic force elsewhere; it may reach to
  /// infinity.
  std::optional<Gap> gap() const { return gap_; }
  /// Slopes at rest. With a gap: those of the outermost pieces, the mean of both where neither is zero, else
  /// the larger. Without: that at x = 0, on a kink that to the right of it.
  double closed_stiffness() const { return closed_.dy_dx; }
  double closed_damping() const { return closed_.dy_dx_dot; }

  /// s: the stiffness that the law is scaled to; slope: its derivative with respect to the angle.
  ScalarResponse evaluate(double x, double x_dot, double s = 1.0, double slope = 0.0) const {
    const Line& l = line_at(x, x_dot, s);
    const double p = x - l.origin, c = l.c + l.product * p, y = l.y + l.k * p;
    ScalarResponse r;
    r.y = s * y + c * x_dot;
    r.dy_dx = s * l.k + l.product * x_dot;
    r.dy_dx_dot = c;
    r.dy_dangle = slope * y;
    r.stored_energy = s * (l.energy + p * (l.elastic + l.half_k * p));
    r.dissipated_power = (s * (l.lost + l.lost_k * p) + c * x_dot) * x_dot;
    return r;
  }

 private:
  /// A piece about an origin p = x - origin. half_k: elastic_k/2. lost: its force less the elastic one.
  struct Line {
    double origin = 0.0, y = 0.0, k = 0.0, c = 0.0, product = 0.0;
    double elastic = 0.0, half_k = 0.0, lost = 0.0, lost_k = 0.0, energy = 0.0;
    double stored(double x) const { return energy + (x - origin) * (elastic + half_k * (x - origin)); }
  };
  /// A piece that may hold between two kinks, and its bounds that depend on x_dot.
  struct Candidate {
    Line line;
    int piece = 0, first = 0, end = 0;
  };
  static constexpr std::size_t kFewKinks = 8;  // one after the other is faster than bisection

  const Line& line_at(double x, double x_dot, double s) const {
    const double* edge = edges_.data();
    if (edges_.size() > kFewKinks + 1)
      edge += count_below(x);
    else
      while (x > *edge) ++edge;
    if (x == *edge) return line_on_edge(x, x_dot, s);
    const int* begin = zone_begin_.data() + (edge - edges_.data());
    const Candidate *candidate = candidates_.data() + begin[0], *end = candidates_.data() + begin[1];
    for (; candidate != end; ++candidate) {
      const LawBound *b = bounds_.data() + candidate->first, *last = bounds_.data() + candidate->end;
      while (b != last && s * (b->a + b->b_x * x) + b->b_v * x_dot > 0.0) ++b;
      if (b == last) return candidate->line;
    }
    return line_on_edge(x, x_dot, s);
  }
  [[gnu::noinline]] const Line& line_on_edge(double x, double x_dot, double s) const;
  std::size_t count_below(double x) const;  // kinks < x
  void find_kinks();
  std::vector<Line> lines() const;
  void find_energies(std::vector<Line>& lines) const;
  void find_candidates(const std::vector<Line>& lines);
  void find_gap();
  void find_closed();

  std::vector<LawPiece> pieces_;
  std::vector<double> edges_;    // the kinks, and infinity
  std::vector<int> zone_begin_;  // of candidates_; zone i lies below edge i
  std::vector<Candidate> candidates_;
  std::vector<LawBound> bounds_;  // bounds of the candidates
  std::optional<Gap> gap_;
  ScalarResponse closed_;
};

/// A ScalarForce that states pieces and nothing else.
class PiecewiseForce : public ScalarForce {
 public:
  explicit PiecewiseForce(std::vector<LawPiece> pieces) : law_(std::move(pieces)) {}
  ScalarResponse evaluate(const ScalarInput& in) const override { return law_.evaluate(in.x, in.x_dot); }
  double closed_stiffness() const override { return law_.closed_stiffness(); }
  double closed_damping() const override { return law_.closed_damping(); }
  std::span<const double> kinks() const override { return law_.kinks(); }
  std::optional<Gap> gap() const override { return law_.gap(); }
  std::span<const LawPiece> pieces() const override { return law_.pieces(); }

 private:
  PiecewiseLaw law_;
};

}  // namespace drev
