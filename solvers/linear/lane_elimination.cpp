#include "solvers/linear/lane_elimination.hpp"

#include "solvers/linear/lane_pair.hpp"

namespace drev {

/// What the loops read and write.
struct LaneElimination::Work {
  int n;
  const int *order, *diagonal_slot, *begin, *row, *slot, *target;
  LaneRow *d_re, *d_im, *d_least;  // pivots; square of the smallest usable one
  LaneRow *l_re, *l_im;            // columns, divided by their pivots once these are known
  const LaneRow *w, *b_re, *b_im;
  LaneRow *x_re, *x_im, *lost;
};

namespace {

using Work = LaneElimination::Work;

template <class Value>
struct Eliminate {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, const Work* work, const LaneDynamics<Value>* dynamics) {
    const Work a = *work;
    const LaneDynamics<Value> s = *dynamics;
    constexpr double kLeast = ComplexElimination::kLostPivot * ComplexElimination::kLostPivot;
    const auto place = [](int row, int set) { return row * kLaneSets + set; };
    // An entry, and the sum of the sizes of its terms.
    const auto entry = [&](int slot, int set, LaneRow& to_re, LaneRow& to_im, L& size)
        __attribute__((always_inline)) {
      L re{}, im{}, inertia{};
      if (slot >= 0) {
        L w;
        take(a.w[set], w), take(of_set(s.k, slot, set), re), take(of_set(s.h, slot, set), im);
        inertia = w * w * s.m[slot];
        im += w * s.c[slot];
      }
      put(re - inertia, to_re), put(im, to_im);
      magnitude(re), magnitude(im), magnitude(inertia);
      size = re + im + inertia;
    };
    L size, x;
    for (int e = 0; e < a.begin[a.n]; ++e)
      for (int set = 0; set < sets; ++set)
        entry(a.slot[e], set, a.l_re[place(e, set)], a.l_im[place(e, set)], size);
    for (int j = 0; j < a.n; ++j)
      for (int set = 0; set < sets; ++set) {
        const int own = place(j, set), row = place(a.order[j], set);
        entry(a.diagonal_slot[j], set, a.d_re[own], a.d_im[own], size);
        const L least = kLeast * size * size;
        size = L{} + std::numeric_limits<double>::min();
        raise(size, least);
        put(size, a.d_least[own]);
        take(a.b_re[row], x), put(x, a.x_re[row]);
        take(a.b_im[row], x), put(x, a.x_im[row]);
      }
    const L one = L{} + 1.0;
    for (int set = 0; set < sets; ++set) a.lost[set] = {};
    int next_update = 0;
    for (int j = 0, update = 0; j < a.n; ++j, next_update = update)
      for (int set = 0; set < sets; ++set) {
        update = next_update;
        const int own = place(j, set), x = place(a.order[j], set);
        L p_re, p_im, least, lost;
        take(a.d_re[own], p_re), take(a.d_im[own], p_im), take(a.d_least[own], least);
        take(a.lost[set], lost);
        size = p_re * p_re + p_im * p_im;
        // Not a number where it is infinite. GCC 12 would take two choices one behind the other to pieces.
        keep_where_not_below(size + 0.0 * size, least, one, lost);
        put(lost, a.lost[set]);
        const L over = 1.0 / size, i_re = p_re * over, i_im = (-1.0 * p_im) * over;
        L known_re, known_im;
        take(a.x_re[x], known_re), take(a.x_im[x], known_im);
        for (int e = a.begin[j]; e < a.begin[j + 1]; ++e) {
          L of_re, of_im;
          take(a.l_re[place(e, set)], of_re), take(a.l_im[place(e, set)], of_im);
          const L re = of_re * i_re - of_im * i_im, im = of_re * i_im + of_im * i_re;
          for (int f = e; f < a.begin[j + 1]; ++f) {
            const int target = a.target[update++], to = place(target < 0 ? -1 - target : target, set);
            LaneRow &to_re = (target < 0 ? a.d_re : a.l_re)[to], &to_im = (target < 0 ? a.d_im : a.l_im)[to];
            L other_re, other_im, sum_re, sum_im;
            take(a.l_re[place(f, set)], other_re), take(a.l_im[place(f, set)], other_im);
            take(to_re, sum_re), take(to_im, sum_im);
            put(sum_re - (re * other_re - im * other_im), to_re);
            put(sum_im - (re * other_im + im * other_re), to_im);
          }
          put(re, a.l_re[place(e, set)]), put(im, a.l_im[place(e, set)]);
          const int row = place(a.order[a.row[e]], set);
          L x_re, x_im;
          take(a.x_re[row], x_re), take(a.x_im[row], x_im);
          put(x_re - (re * known_re - im * known_im), a.x_re[row]);
          put(x_im - (re * known_im + im * known_re), a.x_im[row]);
        }
        put(known_re * i_re - known_im * i_im, a.x_re[x]);
        put(known_re * i_im + known_im * i_re, a.x_im[x]);
      }
    for (int j = a.n - 1; j >= 0; --j)
      for (int set = 0; set < sets; ++set) {
        const int own = place(a.order[j], set);
        L re, im;
        take(a.x_re[own], re), take(a.x_im[own], im);
        for (int e = a.begin[j]; e < a.begin[j + 1]; ++e) {
          const int row = place(a.order[a.row[e]], set);
          L l_re, l_im, x_re, x_im;
          take(a.l_re[place(e, set)], l_re), take(a.l_im[place(e, set)], l_im);
          take(a.x_re[row], x_re), take(a.x_im[row], x_im);
          re -= l_re * x_re - l_im * x_im;
          im -= l_re * x_im + l_im * x_re;
        }
        put(re, a.x_re[own]), put(im, a.x_im[own]);
      }
  }
};

}  // namespace

LaneElimination::LaneElimination(const ComplexElimination& plan) : plan_(plan) {
  for (LaneArray* rows : {&d_re_, &d_im_, &d_least_}) rows->resize(plan.order_.size() * kLaneSets);
  for (LaneArray* rows : {&l_re_, &l_im_}) rows->resize(plan.row_.size() * kLaneSets);
}

template <class Value>
void LaneElimination::solve(int sets, const LaneDynamics<Value>& dynamics, const LaneRow* w,
                            const LaneRow* b_re, const LaneRow* b_im, LaneRow* x_re, LaneRow* x_im,
                            LaneRow* lost) {
  const Work work{plan_.n_,
                  plan_.order_.data(),
                  plan_.diagonal_slot_.data(),
                  plan_.begin_.data(),
                  plan_.row_.data(),
                  plan_.slot_.data(),
                  plan_.target_.data(),
                  d_re_.data(),
                  d_im_.data(),
                  d_least_.data(),
                  l_re_.data(),
                  l_im_.data(),
                  w,
                  b_re,
                  b_im,
                  x_re,
                  x_im,
                  lost};
  run_widest<Eliminate<Value>>(sets, &work, &dynamics);
}

template void LaneElimination::solve(int, const LaneDynamics<double>&, const LaneRow*, const LaneRow*,
                                     const LaneRow*, LaneRow*, LaneRow*, LaneRow*);
template void LaneElimination::solve(int, const LaneDynamics<LaneRow>&, const LaneRow*, const LaneRow*,
                                     const LaneRow*, LaneRow*, LaneRow*, LaneRow*);

}  // namespace drev
