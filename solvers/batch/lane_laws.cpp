#include "solvers/batch/lane_laws.hpp"

#include <algorithm>
#include <limits>

namespace drev {

namespace {

constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();  // as in contact_newton.cpp
constexpr int kMostIterations = 8;

std::span<const LawPiece> pieces_of(const ScalarTerm& term) {
  if (term.phase_node >= 0) return {};
  return term.force->pieces();
}

}  // namespace

LaneLaws::LaneLaws(const std::array<const System*, kLanes>& systems) : laws_(systems[0]->scalars().size()) {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    Law& law = laws_[j];
    const ScalarTerm& first = systems[0]->scalars()[j];
    law.in_pieces = true;
    for (const Entry& e : first.z) law.unknowns.push_back(e.index);
    law.coefficients.resize(first.z.size());
    std::size_t most = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      const ScalarTerm& term = systems[idx(lane)]->scalars()[j];
      law.terms[idx(lane)] = &term;
      for (std::size_t e = 0; e < term.z.size(); ++e) law.coefficients[e].v[lane] = term.z[e].coeff;
      const auto pieces = pieces_of(term);
      law.in_pieces = law.in_pieces && !pieces.empty();
      law.varies = law.varies || term.force->varies();
      law.has_known = law.has_known || term.phase_node >= 0 ||
                      (!term.u.empty() && systems[idx(lane)]->any_prescribed_moves());
      for (const LawPiece& p : pieces) most = std::max(most, p.bounds.size());
    }
    if (law.in_pieces) {
      law.bounds.resize(most);
      for (int lane = 0; lane < kLanes; ++lane) find_piece(law, lane, 0.0, 0.0);
    }
    phased_ = phased_ || first.phase_node >= 0;
    has_known_ = has_known_ || law.has_known;
    varies_ = varies_ || law.varies;
  }
  for (const Law& law : laws_) rows_.insert(rows_.end(), law.unknowns.begin(), law.unknowns.end());
  std::sort(rows_.begin(), rows_.end());
  rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
  for (Law& law : laws_)
    for (const int i : law.unknowns)
      law.places.push_back(static_cast<int>(std::lower_bound(rows_.begin(), rows_.end(), i) - rows_.begin()));
  const std::size_t m = laws_.size();
  for (LaneArray* a : {&free_x_, &free_x_dot_, &x_, &x_dot_, &y_, &dy_dx_, &dy_dx_dot_, &residual_})
    a->resize(m);
  compliance_.resize(m * m);
  tangent_.resize(m * m);
}

void LaneLaws::prepare(LanePointLaws& point) const {
  for (LaneArray* a : {&point.x, &point.x_dot, &point.y, &point.energy, &point.power, &point.angle})
    a->assign(laws_.size(), {});
}

void LaneLaws::take_known(const std::vector<Assembler>& assemblers) {
  for (Law& law : laws_) {
    if (!law.has_known) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      const Assembler& assembler = assemblers[idx(lane)];
      const ScalarTerm& term = *law.terms[idx(lane)];
      double x = 0.0, x_dot = 0.0;
      for (const Entry& e : term.u) {
        x += e.coeff * assembler.prescribed(e.index).value;
        x_dot += e.coeff * assembler.prescribed(e.index).rate;
      }
      if (term.phase_node >= 0) {
        const double n = assembler.system().ratio(term.phase_node);
        const Offset offset = term.force->offset(n * assembler.nominal().value);
        x -= offset.e;
        x_dot -= offset.de_dangle * n * assembler.nominal().rate;
      }
      law.known_x.v[lane] = x;
      law.known_x_dot.v[lane] = x_dot;
    }
  }
}

void LaneLaws::take_angles(const std::vector<Assembler>& assemblers, const LaneMotion& motion,
                           LanePointLaws& to) const {
  for (std::size_t j = 0; j < laws_.size(); ++j)
    for (int lane = 0; lane < kLanes; ++lane) {
      const int node = laws_[j].terms[idx(lane)]->phase_node;
      if (node < 0) continue;
      const Assembler& assembler = assemblers[idx(lane)];
      const NodeMap& map = assembler.system().node_map(node);
      const double q =
          map.unknown >= 0 ? motion.z(map.unknown, lane) : assembler.prescribed(map.prescribed).value;
      to.angle[j].v[lane] = assembler.system().ratio(node) * assembler.nominal().value + map.coeff * q;
    }
}

void LaneLaws::row(int law, LaneArray& b) const {
  std::fill(b.begin(), b.end(), LaneRow{});
  const Law& l = laws_[idx(law)];
  for (std::size_t e = 0; e < l.unknowns.size(); ++e) b[idx(l.unknowns[e])] = l.coefficients[e];
}

void LaneLaws::set_compliance(const LaneArray& w, double kappa_x, double kappa_v) {
  const std::size_t m = laws_.size();
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      Lanes sum{};
      for (std::size_t e = 0; e < laws_[i].unknowns.size(); ++e)
        sum += laws_[i].coefficients[e].v * w[idx(laws_[i].unknowns[e]) * m + j].v;
      compliance_[i * m + j].v = sum;
    }
  kappa_x_ = kappa_x;
  kappa_v_ = kappa_v;
}

void LaneLaws::find_piece(Law& law, int lane, double x, double x_dot) {
  const ScalarForce& force = *law.terms[idx(lane)]->force;
  const std::span<const LawPiece> pieces = force.pieces();
  const LawPiece* found = &pieces[idx(piece_at(pieces, x, x_dot))];
  Piece& p = law.piece;
  p.y_0.v[lane] = found->y_0;
  p.k.v[lane] = found->k;
  p.c.v[lane] = found->c;
  p.product.v[lane] = found->product;
  p.elastic_0.v[lane] = found->elastic_0;
  p.elastic_k.v[lane] = found->elastic_k;
  p.energy_0.v[lane] = force.evaluate({.x = x, .x_dot = x_dot}).stored_energy -
                       (found->elastic_0 + 0.5 * found->elastic_k * x) * x;
  for (std::size_t b = 0; b < law.bounds.size(); ++b) {
    const LawBound bound = b < found->bounds.size() ? found->bounds[b] : LawBound{.a = 1.0};
    law.bounds[b].a.v[lane] = bound.a;
    law.bounds[b].b_x.v[lane] = bound.b_x;
    law.bounds[b].b_v.v[lane] = bound.b_v;
  }
}

void LaneLaws::evaluate(const Law& law, double t, const LaneRow& x, const LaneRow& x_dot,
                        const LaneRow& angle, LaneRow& y, LaneRow& dy_dx, LaneRow& dy_dx_dot) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const ScalarResponse r =
        law.terms[idx(lane)]->force->evaluate({x.v[lane], x_dot.v[lane], t, angle.v[lane]});
    y.v[lane] = r.y;
    dy_dx.v[lane] = r.dy_dx;
    dy_dx_dot.v[lane] = r.dy_dx_dot;
  }
}

struct LaneLawKernels {
  using Law = LaneLaws::Law;
  [[gnu::always_inline]] static inline void respond(Law& law, double t, const LaneRow& x,
                                                    const LaneRow& x_dot, const LaneRow& angle, LaneRow& y,
                                                    LaneRow& dy_dx, LaneRow& dy_dx_dot) {
    if (!law.in_pieces) return LaneLaws::evaluate(law, t, x, x_dot, angle, y, dy_dx, dy_dx_dot);
    LaneMask left{};
    // On a bound piece_at() decides, as everywhere.
    for (const LaneLaws::Bound& b : law.bounds) left |= ~(b.a.v + b.b_x.v * x.v + b.b_v.v * x_dot.v > 0.0);
    if (any(left))
      for (int lane = 0; lane < kLanes; ++lane)
        if (left[lane]) LaneLaws::find_piece(law, lane, x.v[lane], x_dot.v[lane]);
    const LaneLaws::Piece& p = law.piece;
    y.v = p.y_0.v + p.k.v * x.v + (p.c.v + p.product.v * x.v) * x_dot.v;
    dy_dx.v = p.k.v + p.product.v * x_dot.v;
    dy_dx_dot.v = p.c.v + p.product.v * x.v;
  }

  DREV_WIDEST static void solve(LaneLaws& l, const LaneMotion& free, double t, const LaneRow& scale,
                                double tolerance, LaneMask& open, LaneRow* lambda, LanePointLaws& to,
                                LaneRow& iterations) {
    const std::size_t m = l.laws_.size();
    for (std::size_t j = 0; j < m; ++j) {
      const Law& law = l.laws_[j];
      Lanes x = law.known_x.v, x_dot = law.known_x_dot.v;
      for (std::size_t e = 0; e < law.unknowns.size(); ++e) {
        const int i = law.unknowns[e];
        x += law.coefficients[e].v * (free.z_0[i].v + free.kappa_z * free.a[i].v);
        x_dot += law.coefficients[e].v * (free.v_0[i].v + free.kappa_v * free.a[i].v);
      }
      l.free_x_[j].v = x;
      l.free_x_dot_[j].v = x_dot;
    }
    for (int iteration = 0;; ++iteration) {
      LaneMask over{};
      for (std::size_t j = 0; j < m; ++j) {
        Lanes shift{};
        for (std::size_t i = 0; i < m; ++i) shift += l.compliance_[j * m + i].v * lambda[i].v;
        l.x_[j].v = l.free_x_[j].v - l.kappa_x_ * shift;
        l.x_dot_[j].v = l.free_x_dot_[j].v - l.kappa_v_ * shift;
        respond(l.laws_[j], t, l.x_[j], l.x_dot_[j], to.angle[j], l.y_[j], l.dy_dx_[j], l.dy_dx_dot_[j]);
        const Lanes r = l.y_[j].v - lambda[j].v;
        l.residual_[j].v = r;
        Lanes size = r, dx = l.dy_dx_[j].v, dv = l.dy_dx_dot_[j].v, x = l.x_[j].v, x_0 = l.free_x_[j].v,
              w = l.x_dot_[j].v, w_0 = l.free_x_dot_[j].v;
        for (Lanes* part : {&size, &dx, &dv, &x, &x_0, &w, &w_0}) magnitude(*part);
        over |= ~(size - kRounding * (dx * (x + x_0) + dv * (w + w_0)) <= tolerance * scale.v);
      }
      // Lanes that converged keep what they have: it does not depend on their neighbours.
      const LaneMask settled = open & ~over;
      for (std::size_t j = 0; j < m; ++j) {
        to.x[j].v = settled ? l.x_[j].v : to.x[j].v;
        to.x_dot[j].v = settled ? l.x_dot_[j].v : to.x_dot[j].v;
        to.y[j].v = settled ? l.y_[j].v : to.y[j].v;
        lambda[j].v = settled ? l.y_[j].v : lambda[j].v;
      }
      open &= over;
      if (!any(open) || iteration == kMostIterations) return;
      iterations.v += open ? Lanes{} + 1.0 : Lanes{};
      // (I + D G) d = y - lambda with D = kappa_x dy/dx + kappa_v dy/dx'. Its leading minors are those of
      // I + D^1/2 G D^1/2, > 0: no pivoting.
      for (std::size_t j = 0; j < m; ++j) {
        const Lanes slope = l.kappa_x_ * l.dy_dx_[j].v + l.kappa_v_ * l.dy_dx_dot_[j].v;
        for (std::size_t i = 0; i < m; ++i) l.tangent_[j * m + i].v = slope * l.compliance_[j * m + i].v;
        l.tangent_[j * m + j].v += 1.0;
      }
      for (std::size_t k = 0; k < m; ++k) {
        Lanes& inverse = l.tangent_[k * m + k].v;
        inverse = 1.0 / inverse;
        for (std::size_t j = k + 1; j < m; ++j) {
          const Lanes part = l.tangent_[j * m + k].v * inverse;
          for (std::size_t i = k + 1; i < m; ++i) l.tangent_[j * m + i].v -= part * l.tangent_[k * m + i].v;
          l.residual_[j].v -= part * l.residual_[k].v;
        }
      }
      for (std::size_t k = m; k-- > 0;) {
        Lanes sum = l.residual_[k].v;
        for (std::size_t i = k + 1; i < m; ++i) sum -= l.tangent_[k * m + i].v * l.residual_[i].v;
        l.residual_[k].v = sum * l.tangent_[k * m + k].v;
        lambda[k].v = open ? lambda[k].v + l.residual_[k].v : lambda[k].v;
      }
    }
  }

  DREV_WIDEST static void energies(std::vector<Law>& laws, LanePointLaws& p) {
    for (std::size_t j = 0; j < laws.size(); ++j) {
      if (!laws[j].in_pieces) continue;
      const LaneLaws::Piece& piece = laws[j].piece;
      const Lanes x = p.x[j].v, x_dot = p.x_dot[j].v;
      p.energy[j].v = piece.energy_0.v + (piece.elastic_0.v + 0.5 * piece.elastic_k.v * x) * x;
      p.power[j].v = (p.y[j].v - (piece.elastic_0.v + piece.elastic_k.v * x)) * x_dot;
    }
  }
};

void LaneLaws::solve(const LaneMotion& free, double t, const LaneRow& scale, double tolerance, LaneMask& open,
                     LaneRow* lambda, LanePointLaws& to, LaneRow& iterations) {
  to.t = t;
  LaneLawKernels::solve(*this, free, t, scale, tolerance, open, lambda, to, iterations);
}

void LaneLaws::energies(LanePointLaws& p) {
  LaneLawKernels::energies(laws_, p);
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    if (laws_[j].in_pieces) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      const ScalarResponse r = laws_[j].terms[idx(lane)]->force->evaluate(
          {p.x[j].v[lane], p.x_dot[j].v[lane], p.t, p.angle[j].v[lane]});
      p.energy[j].v[lane] = r.stored_energy;
      p.power[j].v[lane] = r.dissipated_power;
    }
  }
}

void LaneLaws::forces(const LaneArray& y, LaneForces& by) const {
  by.rows = rows_;
  by.values.assign(rows_.size(), {});
  for (std::size_t j = 0; j < laws_.size(); ++j)
    for (std::size_t e = 0; e < laws_[j].places.size(); ++e)
      by.values[idx(laws_[j].places[e])].v += laws_[j].coefficients[e].v * y[j].v;
}

void LaneLaws::add_extra_input(const LanePointLaws& from, const LaneRow* z_0, const LanePointLaws& to,
                               const LaneMotion& end, LaneRow& input) const {
  for (std::size_t j = 0; j < laws_.size(); ++j) {
    const Law& law = laws_[j];
    if (law.has_known) {
      Lanes moved = to.x[j].v - from.x[j].v;
      for (std::size_t e = 0; e < law.unknowns.size(); ++e) {
        const int i = law.unknowns[e];
        moved -= law.coefficients[e].v * (end.z_0[i].v + end.kappa_z * end.a[i].v - z_0[i].v);
      }
      input.v += 0.5 * (from.y[j].v + to.y[j].v) * moved;
    }
    if (!law.varies) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      const ScalarForce& force = *law.terms[idx(lane)]->force;
      if (!force.varies()) continue;
      const double v01 =
          force.evaluate({from.x[j].v[lane], from.x_dot[j].v[lane], to.t, to.angle[j].v[lane]}).stored_energy;
      const double v10 =
          force.evaluate({to.x[j].v[lane], to.x_dot[j].v[lane], from.t, from.angle[j].v[lane]}).stored_energy;
      input.v[lane] += 0.5 * ((v01 - from.energy[j].v[lane]) + (to.energy[j].v[lane] - v10));
    }
  }
}

}  // namespace drev
