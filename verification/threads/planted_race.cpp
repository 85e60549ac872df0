/// Deliberate races of the kinds that the solver's loops could have: unless the thread sanitizer reports each
/// of them, its silence about the solver means nothing. The argument selects one; without it there is no
/// race.

#include <cstdio>
#include <string>

#include "base/parallel.hpp"
#include "math/pack.hpp"
#include "math/rows.hpp"

using namespace sandglass;

int main(int argc, char** argv) {
  const std::string race = argc > 1 ? argv[1] : "none";
  Rows<double> rows(64);
  const std::array<Place, 8> first{place_of_row(0), place_of_row(1), place_of_row(2), place_of_row(3),
                                   place_of_row(4), place_of_row(5), place_of_row(6), place_of_row(7)};
  const std::array<Place, 8> last{place_of_row(40), place_of_row(41), place_of_row(42), place_of_row(43),
                                  place_of_row(44), place_of_row(45), place_of_row(46), place_of_row(47)};
  const std::array<Pack<double>, 3> force{Pack<double>(1.0), Pack<double>(2.0), Pack<double>(3.0)};
  double sum = 0.0;
  in_parallel(2, 2, [&](std::size_t k) {
    if (race == "sum") sum += 1.0;  // two threads into one number
    const bool same = race == "rows" || k == 0;
    scatter_add<Pack<double>>(force, numbers_of(rows), (same ? first : last).data());  // or into one row
  });
  in_parallel(2, 2, [&](std::size_t k) {  // the other thread's result of the first loop
    if (k == 0) sum += rows[40][1];
  });
  std::printf("%g\n", sum);
}
