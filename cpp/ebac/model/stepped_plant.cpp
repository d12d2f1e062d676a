#include "ebac/model/stepped_plant.hpp"
namespace ebac {
SteppedPlant::SteppedPlant(const DeviceModel&, const Hand&, double) {}
void SteppedPlant::advance(const Axes&, double, std::int64_t) EBAC_RT {}
}  // namespace ebac
