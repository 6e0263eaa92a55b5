#include "solvers/linear/lane_elimination.hpp"

namespace drev {

/// What the loops read and write.
struct LaneElimination::Work {
  int n;
  const int *order, *diagonal_slot, *begin, *row, *slot, *target;
  LaneRow *d_re, *d_im, *l_re, *l_im, *w_re, *w_im, *x_re, *x_im, *re, *im;
};

namespace {

using Work = LaneElimination::Work;

template <class Value>
[[gnu::always_inline]] inline void eliminate(const Work& a, const double* m, const Value* c, const Value* k,
                                             const Lanes& w, Lanes& lost) {
  const Lanes w_2 = w * w;
  const auto entries = a.begin[a.n];
  for (int e = 0; e < entries; ++e) {
    const int slot = a.slot[e];
    a.w_re[e].v = slot < 0 ? Lanes{} : each(k[slot]) - w_2 * m[slot];
    a.w_im[e].v = slot < 0 ? Lanes{} : w * each(c[slot]);
  }
  for (int j = 0; j < a.n; ++j) {
    const int slot = a.diagonal_slot[j], unknown = a.order[j];
    a.d_re[j].v = slot < 0 ? Lanes{} : each(k[slot]) - w_2 * m[slot];
    a.d_im[j].v = slot < 0 ? Lanes{} : w * each(c[slot]);
    a.x_re[j] = a.re[unknown];
    a.x_im[j] = a.im[unknown];
  }
  const double least = ComplexElimination::kLostPivot * ComplexElimination::kLostPivot;
  int update = 0;
  for (int j = 0; j < a.n; ++j) {
    const Lanes p_re = a.d_re[j].v, p_im = a.d_im[j].v;
    Lanes terms{};
    if (const int slot = a.diagonal_slot[j]; slot >= 0) {
      Lanes of_k = Lanes{} + each(k[slot]), of_c = w * each(c[slot]), of_m = w_2 * m[slot];
      magnitude(of_k), magnitude(of_c), magnitude(of_m);
      terms = of_k + of_c + of_m;
    }
    const Lanes size = p_re * p_re + p_im * p_im;
    // Choices between doubles: GCC 12 takes masks of lanes to pieces.
    const Lanes one = Lanes{} + 1.0, most = Lanes{} + std::numeric_limits<double>::max();
    lost = size > least * terms * terms ? lost : one;
    lost = size <= most ? lost : one;
    const Lanes over = 1.0 / size, i_re = p_re * over, i_im = -p_im * over;
    const Lanes known_re = a.x_re[j].v, known_im = a.x_im[j].v;
    for (int e = a.begin[j]; e < a.begin[j + 1]; ++e) {
      const Lanes re = a.w_re[e].v * i_re - a.w_im[e].v * i_im, im = a.w_re[e].v * i_im + a.w_im[e].v * i_re;
      a.l_re[e].v = re;
      a.l_im[e].v = im;
      for (int f = e; f < a.begin[j + 1]; ++f) {
        const int target = a.target[update++];
        LaneRow& to_re = target < 0 ? a.d_re[-1 - target] : a.w_re[target];
        LaneRow& to_im = target < 0 ? a.d_im[-1 - target] : a.w_im[target];
        to_re.v -= re * a.w_re[f].v - im * a.w_im[f].v;
        to_im.v -= re * a.w_im[f].v + im * a.w_re[f].v;
      }
      const int row = a.row[e];
      a.x_re[row].v -= re * known_re - im * known_im;
      a.x_im[row].v -= re * known_im + im * known_re;
    }
    a.x_re[j].v = known_re * i_re - known_im * i_im;
    a.x_im[j].v = known_re * i_im + known_im * i_re;
  }
  for (int j = a.n - 1; j >= 0; --j) {
    Lanes re = a.x_re[j].v, im = a.x_im[j].v;
    for (int e = a.begin[j]; e < a.begin[j + 1]; ++e) {
      const int row = a.row[e];
      re -= a.l_re[e].v * a.x_re[row].v - a.l_im[e].v * a.x_im[row].v;
      im -= a.l_re[e].v * a.x_im[row].v + a.l_im[e].v * a.x_re[row].v;
    }
    a.x_re[j].v = a.re[a.order[j]].v = re;
    a.x_im[j].v = a.im[a.order[j]].v = im;
  }
}

DREV_WIDEST void eliminate_common(const Work& a, const double* m, const double* c, const double* k,
                                  const Lanes& w, Lanes& lost) {
  eliminate(a, m, c, k, w, lost);
}
DREV_WIDEST void eliminate_each(const Work& a, const double* m, const LaneRow* c, const LaneRow* k,
                                const Lanes& w, Lanes& lost) {
  eliminate(a, m, c, k, w, lost);
}

}  // namespace

LaneElimination::LaneElimination(const ComplexElimination& plan)
    : plan_(plan),
      d_re_(plan.order_.size()),
      d_im_(plan.order_.size()),
      l_re_(plan.row_.size()),
      l_im_(plan.row_.size()),
      w_re_(plan.row_.size()),
      w_im_(plan.row_.size()),
      x_re_(plan.order_.size()),
      x_im_(plan.order_.size()) {}

LaneElimination::Work LaneElimination::work(LaneArray& re, LaneArray& im) {
  return {plan_.n_,
          plan_.order_.data(),
          plan_.diagonal_slot_.data(),
          plan_.begin_.data(),
          plan_.row_.data(),
          plan_.slot_.data(),
          plan_.target_.data(),
          d_re_.data(),
          d_im_.data(),
          l_re_.data(),
          l_im_.data(),
          w_re_.data(),
          w_im_.data(),
          x_re_.data(),
          x_im_.data(),
          re.data(),
          im.data()};
}

void LaneElimination::solve(const double* m, const double* c, const double* k, const Lanes& w, LaneArray& re,
                            LaneArray& im, Lanes& lost) {
  lost = Lanes{};
  eliminate_common(work(re, im), m, c, k, w, lost);
}

void LaneElimination::solve(const double* m, const LaneRow* c, const LaneRow* k, const Lanes& w,
                            LaneArray& re, LaneArray& im, Lanes& lost) {
  lost = Lanes{};
  eliminate_each(work(re, im), m, c, k, w, lost);
}

}  // namespace drev
