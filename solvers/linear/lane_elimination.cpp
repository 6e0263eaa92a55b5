#include "solvers/linear/lane_elimination.hpp"

#include "solvers/linear/lane_pair.hpp"

namespace drev {

/// What the loops read and write.
struct LaneElimination::Work {
  int n;
  const int *order, *diagonal_slot, *begin, *row, *slot, *target;
  LaneRow *d_re, *d_im, *l_re, *l_im, *w_re, *w_im, *x_re, *x_im, *re, *im;
};

namespace {

using Work = LaneElimination::Work;

/// With one C and K for all lanes (Value double), or for each (LaneRow).
template <class Value>
struct Eliminate {
  template <class L>
  [[gnu::always_inline]] static void run(const Work* work, const double* m, const Value* c, const Value* k,
                                         const LaneRow* frequencies, LaneRow* result) {
    const Work& a = *work;
    L w, lost{};
    take(*frequencies, w);
    const L w_2 = w * w;
    const auto dynamic = [&](int slot, LaneRow& to_re, LaneRow& to_im) __attribute__((always_inline)) {
      L re{}, im{};
      if (slot >= 0) {
        take(k[slot], re), take(c[slot], im);
        re -= w_2 * m[slot];
        im *= w;
      }
      put(re, to_re), put(im, to_im);
    };
    const auto entries = a.begin[a.n];
    for (int e = 0; e < entries; ++e) dynamic(a.slot[e], a.w_re[e], a.w_im[e]);
    for (int j = 0; j < a.n; ++j) {
      dynamic(a.diagonal_slot[j], a.d_re[j], a.d_im[j]);
      a.x_re[j] = a.re[a.order[j]];
      a.x_im[j] = a.im[a.order[j]];
    }
    const double least = ComplexElimination::kLostPivot * ComplexElimination::kLostPivot;
    const L one = L{} + 1.0, most = L{} + std::numeric_limits<double>::max();
    int update = 0;
    for (int j = 0; j < a.n; ++j) {
      L p_re, p_im, terms{};
      take(a.d_re[j], p_re), take(a.d_im[j], p_im);
      if (const int slot = a.diagonal_slot[j]; slot >= 0) {
        L of_c, of_m = w_2 * m[slot];
        take(k[slot], terms), take(c[slot], of_c);
        of_c *= w;
        magnitude(terms), magnitude(of_c), magnitude(of_m);
        terms += of_c + of_m;
      }
      const L size = p_re * p_re + p_im * p_im;
      keep_where_not_below(size, L{} + std::numeric_limits<double>::min(), one, lost);
      keep_where_not_below(size, least * terms * terms, one, lost);
      keep_where_not_below(most, size, one, lost);
      const L over = 1.0 / size, i_re = p_re * over, i_im = (-1.0 * p_im) * over;
      L known_re, known_im;
      take(a.x_re[j], known_re), take(a.x_im[j], known_im);
      for (int e = a.begin[j]; e < a.begin[j + 1]; ++e) {
        L of_re, of_im;
        take(a.w_re[e], of_re), take(a.w_im[e], of_im);
        const L re = of_re * i_re - of_im * i_im, im = of_re * i_im + of_im * i_re;
        put(re, a.l_re[e]), put(im, a.l_im[e]);
        for (int f = e; f < a.begin[j + 1]; ++f) {
          const int target = a.target[update++];
          LaneRow& to_re = target < 0 ? a.d_re[-1 - target] : a.w_re[target];
          LaneRow& to_im = target < 0 ? a.d_im[-1 - target] : a.w_im[target];
          L other_re, other_im, sum_re, sum_im;
          take(a.w_re[f], other_re), take(a.w_im[f], other_im);
          take(to_re, sum_re), take(to_im, sum_im);
          put(sum_re - (re * other_re - im * other_im), to_re);
          put(sum_im - (re * other_im + im * other_re), to_im);
        }
        const int row = a.row[e];
        L x_re, x_im;
        take(a.x_re[row], x_re), take(a.x_im[row], x_im);
        put(x_re - (re * known_re - im * known_im), a.x_re[row]);
        put(x_im - (re * known_im + im * known_re), a.x_im[row]);
      }
      put(known_re * i_re - known_im * i_im, a.x_re[j]);
      put(known_re * i_im + known_im * i_re, a.x_im[j]);
    }
    for (int j = a.n - 1; j >= 0; --j) {
      L re, im;
      take(a.x_re[j], re), take(a.x_im[j], im);
      for (int e = a.begin[j]; e < a.begin[j + 1]; ++e) {
        const int row = a.row[e];
        L l_re, l_im, x_re, x_im;
        take(a.l_re[e], l_re), take(a.l_im[e], l_im), take(a.x_re[row], x_re), take(a.x_im[row], x_im);
        re -= l_re * x_re - l_im * x_im;
        im -= l_re * x_im + l_im * x_re;
      }
      put(re, a.x_re[j]), put(re, a.re[a.order[j]]);
      put(im, a.x_im[j]), put(im, a.im[a.order[j]]);
    }
    put(lost, *result);
  }
};

template <class Value>
void eliminate(const Work& work, const double* m, const Value* c, const Value* k, const Lanes& w,
               Lanes& lost) {
  const LaneRow frequencies{w};
  LaneRow result;
  run_widest<Eliminate<Value>>(&work, m, c, k, &frequencies, &result);
  lost = result.v;
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
  eliminate(work(re, im), m, c, k, w, lost);
}

void LaneElimination::solve(const double* m, const LaneRow* c, const LaneRow* k, const Lanes& w,
                            LaneArray& re, LaneArray& im, Lanes& lost) {
  eliminate(work(re, im), m, c, k, w, lost);
}

}  // namespace drev
