#include "ebac/model/kinematics.hpp"

namespace ebac {

int axes(const Kinematics& kinematics) EBAC_RT {
  return std::visit([](const auto& k) { return axes(k); }, kinematics);
}
double radius(const Kinematics& kinematics) EBAC_RT {
  return std::visit([](const auto& k) { return k.radius; }, kinematics);
}
Axes travel(const Kinematics& kinematics) EBAC_RT {
  return std::visit([](const auto& k) { return k.travel(); }, kinematics);
}
Axes stops(const Kinematics& kinematics) EBAC_RT {
  return std::visit([](const auto& k) { return k.stops(); }, kinematics);
}
double stretch(const Kinematics& kinematics) EBAC_RT {
  const auto* slide = std::get_if<SlidingGimbal>(&kinematics);
  return slide == nullptr ? 1 : slide->stretch();
}
Axes forward(const Kinematics& kinematics, const Axes& q) EBAC_RT {
  return std::visit([&](const auto& k) { return k.forward(q); }, kinematics);
}
Axes inverse(const Kinematics& kinematics, const Axes& x) EBAC_RT {
  return std::visit([&](const auto& k) { return k.inverse(x); }, kinematics);
}
Jacobian jacobian(const Kinematics& kinematics, const Axes& q) EBAC_RT {
  return std::visit([&](const auto& k) { return k.jacobian(q); }, kinematics);
}
Axes transpose(const Kinematics& kinematics, const Axes& q, const Axes& f) EBAC_RT {
  return jacobian(kinematics, q).transpose() * f;
}
Axes weight(const Kinematics& kinematics, const Axes& q, double newton) EBAC_RT {
  return std::visit([&](const auto& k) { return k.weight(q, newton); }, kinematics);
}
bool within_limits(const Kinematics& kinematics, const Axes& q) EBAC_RT {
  return std::visit(
      [&](const auto& k) {
        const Axes most = k.stops();
        for (int i = 0; i < axes(k); ++i) {
          if (!(std::abs(q[i]) <= most[i])) return false;
        }
        return true;
      },
      kinematics);
}

}  // namespace ebac
