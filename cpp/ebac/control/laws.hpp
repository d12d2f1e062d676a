#pragma once

#include <tuple>

#include "ebac/control/direct.hpp"
#include "ebac/control/eba.hpp"
#include "ebac/control/eba_account.hpp"
#include "ebac/control/ebac.hpp"
#include "ebac/control/ebac_printed.hpp"
#include "ebac/control/force_bounding.hpp"
#include "ebac/control/iss.hpp"
#include "ebac/control/lag_compensator.hpp"
#include "ebac/control/passivity_control.hpp"
#include "ebac/control/sfa.hpp"
#include "ebac/control/tca.hpp"
#include "ebac/control/tca_damped.hpp"
#include "ebac/control/virtual_coupling.hpp"

namespace ebac {

/// Every law the library ships; tests and benchmarks run over this list.
using Laws = std::tuple<Direct, Tca, TcaDamped, LagCompensator, PassivityControl, Iss,
                        VirtualCoupling, Sfa, ForceBounding, Eba, EbaAccount, EbacPrinted, Ebac>;

}  // namespace ebac
