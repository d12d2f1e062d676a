#include <utility>

#include "ebac/world/engine/bridge.hpp"

namespace ebac::world {

std::unique_ptr<Bridge> make_scheduled(std::unique_ptr<Engine> engine, const EngineTiming& timing,
                                       const BridgeParams& params, bool held) {
  return std::make_unique<BridgeOver<ScheduledModels>>(
      ScheduledModels(std::move(engine), timing), params, held, std::make_shared<BridgeReport>());
}

std::unique_ptr<Bridge> make_posted(std::shared_ptr<EngineChannel> channel,
                                    const BridgeParams& params) {
  return std::make_unique<BridgeOver<PostedModels>>(PostedModels(std::move(channel)), params, false,
                                                    std::make_shared<BridgeReport>());
}

}  // namespace ebac::world
