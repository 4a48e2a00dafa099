/// How much masses differ among particles that are joined.
#include "engine/model/unevenness.h"

#include <doctest/doctest.h>

#include <vector>

namespace weft::test::engine_model_unevenness {
namespace {

struct Joined {
  std::vector<double> inverse_mass;
  std::vector<std::uint32_t> a, b;
  std::vector<double> rest_length;

  Unevenness uneven() const { return find_unevenness(inverse_mass, a, b, rest_length); }
  void join(std::uint32_t from, std::uint32_t to, double length) {
    a.push_back(from);
    b.push_back(to);
    rest_length.push_back(length);
  }
};

TEST_CASE("nothing joined, or all fixed, is even") {
  for (const double w : {0.0, 2.0}) {
    Joined none{{w, w}, {}, {}, {}};
    CHECK(none.uneven().ratio == 1);
    CHECK(none.uneven().per_metre == 0);
  }
}

TEST_CASE("the heaviest to the lightest of a part, over its mean length, however far apart") {
  Joined chain{{0.001, 0.5, 0.25, 4}, {}, {}, {}};
  chain.join(3, 2, 0.5);
  chain.join(0, 1, 0.5);
  chain.join(1, 2, 2);
  CHECK(chain.uneven().ratio == 4000);
  CHECK(chain.uneven().per_metre == 4000);  // the mean is 1 m
  CHECK(chain.uneven().lightness == 4);
  CHECK(chain.uneven().lightness_per_metre == 4);
}

TEST_CASE("parts are judged one by one, and fixed particles join none") {
  // heavy - fixed - light - light, and two of middling mass apart
  Joined parts{{0.01, 0, 100, 50, 1, 3}, {}, {}, {}};
  parts.join(0, 1, 1);
  parts.join(1, 2, 1);
  parts.join(2, 3, 0.25);
  parts.join(4, 5, 0.1);
  CHECK(parts.uneven().ratio == 3);
  CHECK(parts.uneven().per_metre == doctest::Approx(30));
  CHECK(parts.uneven().lightness == 100);
  CHECK(parts.uneven().lightness_per_metre == doctest::Approx(200));
}

TEST_CASE("what is not joined to anything does not count") {
  Joined sheet{{1, 2, 1e-9}, {}, {}, {}};
  sheet.join(0, 1, 1);
  CHECK(sheet.uneven().ratio == 2);
}

}  // namespace
}  // namespace weft::test::engine_model_unevenness
