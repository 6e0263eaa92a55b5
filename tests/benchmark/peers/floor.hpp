#pragma once
/// Bare loops of the arithmetic that exact propagation of the Chain cannot do without, in seconds
/// apiece: one degree of its Taylor series, one look at a load, one root of a gap's polynomial.
#include "tests/benchmark/peers/chain.hpp"

namespace peers {

double seconds_per_degree(const Chain& chain);
double seconds_per_load(const Chain& chain);  ///< table or pulse, of those with an amplitude
double seconds_per_root();                    ///< Newton on degree 16, four iterations

}  // namespace peers
