#pragma once

#include <tuple>

#include "ebac/control/direct.hpp"
#include "ebac/control/eba.hpp"
#include "ebac/control/ebac.hpp"
#include "ebac/control/ebac_printed.hpp"
#include "ebac/control/tca.hpp"

namespace ebac {

/// Every law the library ships; tests and benchmarks run over this list.
using Laws = std::tuple<Direct, Tca, Eba, EbacPrinted, Ebac>;

}  // namespace ebac
