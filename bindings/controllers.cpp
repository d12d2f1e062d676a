#include "controllers.hpp"

#include "bind.hpp"
#include "ebac/control/laws.hpp"

namespace ebac::python {

/// A new law: its header above, one line here.
void bind_controllers(py::module_& m) {
  bind_controller<Direct>(m, "Direct");
  bind_controller<Tca>(m, "TCA");
  bind_controller<TcaDamped>(m, "TCADamped");
  bind_controller<PassivityControl>(m, "PassivityControl");
  bind_controller<VirtualCoupling>(m, "VirtualCoupling");
  bind_controller<ForceBounding>(m, "ForceBounding");
  bind_controller<Eba>(m, "EBA");
  bind_controller<EbacPrinted>(m, "EBACPrinted");
  bind_controller<Ebac>(m, "EBAC");
}

}  // namespace ebac::python
