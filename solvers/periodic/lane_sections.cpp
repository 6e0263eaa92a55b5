#include "solvers/periodic/lane_sections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

/// Rows with few entries, as the loops read them.
struct LaneSections::Sparse {
  const int *begin, *index;
  const double* coeff;
  const double* of_twist = nullptr;  // multiple of the section's twist in each row, besides its entries
};

namespace {

using Sparse = LaneSections::Sparse;

struct AddLoads {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, int loads, const Sparse* rows, const double* given,
                                         LaneRow* p_re, LaneRow* p_im) {
    for (int l = 0; l < loads; ++l, given += 2 * LaneSections::kFrequencies)
      for (int set = 0; set < sets; ++set) {
        L re, im, sum;
        take_pairs(given + 2 * kLanes * set, re, im);
        for (int e = rows->begin[l]; e < rows->begin[l + 1]; ++e) {
          const int to = rows->index[e] * kLaneSets + set;
          take(p_re[to], sum), put(sum + rows->coeff[e] * re, p_re[to]);
          take(p_im[to], sum), put(sum + rows->coeff[e] * im, p_im[to]);
        }
      }
  }
};

/// Torques, twists and heat from the products of a section's rows with z. Rates are i w times the deflections. With a
/// frequency term, the torque is that of the matrices plus the part beyond them, and heat = w/2 Im(T conj x).
struct FindSections {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, int sections, const Sparse* rows, const int* terms,
                                         const LaneSections::Motion* z, const LaneRow* k_re,
                                         const LaneRow* k_im, double* torques, double* twists,
                                         double* heats) {
    using Rows = LaneSections;
    for (int s = 0; s < sections; ++s) {
      const int* begin = rows->begin + s * Rows::kRows;
      const double* of_twist = rows->of_twist + s * Rows::kRows;
      L all_heat{};
      for (int set = 0; set < sets; ++set) {
        L w, twist_re{}, twist_im{}, torque_re, torque_im, row_re, row_im;
        const auto product = [&](int row, L& re, L& im) __attribute__((always_inline)) {
          L x;
          re = of_twist[row] * twist_re, im = of_twist[row] * twist_im;
          for (int e = begin[row]; e < begin[row + 1]; ++e) {
            const int from = rows->index[e] * kLaneSets + set;
            take(z->re[from], x), re += rows->coeff[e] * x;
            take(z->im[from], x), im += rows->coeff[e] * x;
          }
        };
        take(z->w[set], w);
        product(Rows::twist, twist_re, twist_im);
        product(Rows::stiffness, torque_re, torque_im);
        product(Rows::damping, row_re, row_im);
        torque_re -= w * row_im;
        torque_im += w * row_re;
        L heat;
        if (terms[s] >= 0) {
          L a, b;
          take(k_re[terms[s] * kLaneSets + set], a), take(k_im[terms[s] * kLaneSets + set], b);
          product(Rows::beyond, row_re, row_im);
          torque_re += a * row_re - b * row_im;
          torque_im += a * row_im + b * row_re;
          heat = 0.5 * w * (torque_im * twist_re - torque_re * twist_im);
        } else {
          product(Rows::damper, row_re, row_im);
          heat = 0.5 * w * w * (row_re * twist_re + row_im * twist_im);
        }
        all_heat += heat;
        const int at = 2 * (s * Rows::kFrequencies + set * kLanes);
        put_pairs(torque_re, torque_im, torques + at);
        put_pairs(twist_re, twist_im, twists + at);
      }
      heats[s] = sum_of(all_heat);
    }
  }
};

/// The columns of a matrix without those of held unknowns.
struct Columns {
  int count;
  const int *unknowns, *outer, *inner, *slots;
};

template <class Value>
struct FindPowers {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, const Columns* a, const LaneSections::Motion* z,
                                         const LaneDynamics<Value>* s, LaneSections::Powers* found) {
    L all_in{}, all_lost{};
    for (int set = 0; set < sets; ++set) {
      L in{}, lost{}, w;
      take(z->w[set], w);
      for (int j = 0; j < a->count; ++j) {
        const int unknown = a->unknowns[j] * kLaneSets + set;
        L x_re, x_im, of_re, of_im, h, force_re{}, force_im{};
        take(z->re[unknown], x_re), take(z->im[unknown], x_im);
        take(z->p_re[unknown], of_re), take(z->p_im[unknown], of_im);
        in += x_re * of_im - x_im * of_re;
        for (int e = a->outer[j]; e < a->outer[j + 1]; ++e) {
          const int from = a->inner[e] * kLaneSets + set;
          take(of_set(s->h, a->slots[e], set), h);
          h += w * s->c[a->slots[e]];
          take(z->re[from], of_re), take(z->im[from], of_im);
          force_re += h * of_re;
          force_im += h * of_im;
        }
        lost += x_re * force_re + x_im * force_im;
      }
      all_in += 0.5 * w * in;
      all_lost += 0.5 * w * lost;
    }
    *found = {sum_of(all_in), sum_of(all_lost)};
  }
};

struct SpreadAtSlots {
  template <class L>
  [[gnu::always_inline]] static void run(int sets, int values, int additions, const int* slots,
                                         const int* terms, const double* times, const LaneRow* re,
                                         const LaneRow* im, const double* common, LaneRow* k, LaneRow* h) {
    L x, sum;
    for (int v = 0; v < values; ++v)
      for (int set = 0; set < sets; ++set) {
        take(common[v], x);
        put(x, k[v * kLaneSets + set]), put(L{}, h[v * kLaneSets + set]);
      }
    for (int i = 0; i < additions; ++i)
      for (int set = 0; set < sets; ++set) {
        const int from = terms[i] * kLaneSets + set, to = slots[i] * kLaneSets + set;
        take(re[from], x), take(k[to], sum), put(sum + times[i] * x, k[to]);
        take(im[from], x), take(h[to], sum), put(sum + times[i] * x, h[to]);
      }
  }
};

/// The factor by which `row` is a multiple of `of`, to rounding; 0: it is none.
double multiple_of(const std::vector<Entry>& of, const std::vector<Entry>& row) {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  if (row.empty() || row.size() != of.size()) return 0.0;
  const double factor = row[0].coeff / of[0].coeff;
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i].index != of[i].index ||
        !(std::abs(row[i].coeff - factor * of[i].coeff) <= kRounding * std::abs(row[i].coeff)))
      return 0.0;
  return factor;
}

double* numbers_of(std::vector<std::complex<double>>& values) {
  return reinterpret_cast<double*>(values.data());
}

}  // namespace

void LaneSections::RowList::add(const std::vector<Entry>& row, const std::vector<bool>& held) {
  for (const Entry& e : row) {
    if (held[idx(e.index)]) continue;
    index.push_back(e.index);
    coeff.push_back(e.coeff);
  }
  begin.push_back(static_cast<int>(index.size()));
}

LaneSections::LaneSections(const System& system, const std::vector<std::vector<Entry>>& loads,
                           const std::vector<SectionRows>& sections, const std::vector<bool>& held) {
  const SparseMatrix& pattern = system.pattern();
  outer_.push_back(0);
  for (int j = 0; j < system.size(); ++j) {
    if (held[idx(j)]) continue;
    unknowns_.push_back(j);
    for (int slot = pattern.outerIndexPtr()[j]; slot < pattern.outerIndexPtr()[j + 1]; ++slot)
      if (const int row = pattern.innerIndexPtr()[slot]; !held[idx(row)])
        inner_.push_back(row), slots_.push_back(slot);
    outer_.push_back(static_cast<int>(inner_.size()));
  }
  for (const std::vector<Entry>& load : loads) loads_.add(load, held);
  loaded_ = loads_.index;
  std::sort(loaded_.begin(), loaded_.end());
  loaded_.erase(std::unique(loaded_.begin(), loaded_.end()), loaded_.end());
  for (const SectionRows& s : sections) {
    term_.push_back(s.frequency_term);
    const std::vector<Entry> none,
        &beyond = s.frequency_term < 0 ? none : system.frequency_terms()[idx(s.frequency_term)].z;
    for (const std::vector<Entry>* row : {&s.twist, &s.stiffness, &s.damping, &s.damper, &beyond}) {
      of_twist_.push_back(row == &s.twist ? 0.0 : multiple_of(s.twist, *row));
      rows_.add(of_twist_.back() != 0.0 ? none : *row, held);
    }
  }
  heat_.resize(sections.size());
  for (auto* values : {&torque_, &twist_}) values->resize(sections.size() * kFrequencies);
}

void LaneSections::add_loads(int sets, const std::vector<std::complex<double>>& given, LaneRow* p_re,
                             LaneRow* p_im) const {
  for (const int unknown : loaded_)
    for (int set = 0; set < sets; ++set)
      p_re[unknown * kLaneSets + set] = p_im[unknown * kLaneSets + set] = {};
  const Sparse rows{loads_.begin.data(), loads_.index.data(), loads_.coeff.data()};
  run_widest<AddLoads>(sets, static_cast<int>(loads_.begin.size()) - 1, &rows,
                       reinterpret_cast<const double*>(given.data()), p_re, p_im);
}

void LaneSections::find(int sets, const Motion& motion, const LaneArray& k_re, const LaneArray& k_im) {
  const Sparse rows{rows_.begin.data(), rows_.index.data(), rows_.coeff.data(), of_twist_.data()};
  run_widest<FindSections>(sets, static_cast<int>(term_.size()), &rows, term_.data(), &motion, k_re.data(),
                           k_im.data(), numbers_of(torque_), numbers_of(twist_), heat_.data());
}

template <class Value>
LaneSections::Powers LaneSections::powers(int sets, const Motion& motion,
                                          const LaneDynamics<Value>& dynamics) const {
  const Columns columns{static_cast<int>(unknowns_.size()), unknowns_.data(), outer_.data(), inner_.data(),
                        slots_.data()};
  Powers found;
  run_widest<FindPowers<Value>>(sets, &columns, &motion, &dynamics, &found);
  return found;
}

template LaneSections::Powers LaneSections::powers(int, const Motion&, const LaneDynamics<double>&) const;
template LaneSections::Powers LaneSections::powers(int, const Motion&, const LaneDynamics<LaneRow>&) const;

void spread_at_slots(int sets, const std::vector<int>& slots, const std::vector<int>& terms,
                     const std::vector<double>& times, const LaneArray& re, const LaneArray& im,
                     const Vector& common, LaneArray& k, LaneArray& h) {
  run_widest<SpreadAtSlots>(sets, static_cast<int>(common.size()), static_cast<int>(slots.size()),
                            slots.data(), terms.data(), times.data(), re.data(), im.data(), common.data(),
                            k.data(), h.data());
}

}  // namespace drev
