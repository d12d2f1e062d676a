#include "ebac/rt/grants.hpp"

#include <string>

#include "ebac/rt/awake_cpus.hpp"

namespace ebac::rt {

namespace {

Grant refused(std::string name, std::string asked) {
  return {std::move(name), std::move(asked), false,
          "this build of ebac asks the system for nothing", "use Linux"};
}

}  // namespace

Grant ask_priority(int priority) { return refused("priority", std::to_string(priority)); }
Grant ask_cpu(int cpu) { return refused("cpu", "CPU " + std::to_string(cpu)); }
Grant ask_memory() { return refused("memory", "all pages locked"); }
void release_memory() noexcept {}
Grant touch_stack(int bytes) { return refused("stack", std::to_string(bytes) + " bytes touched"); }

AwakeCpus::~AwakeCpus() = default;
Grant AwakeCpus::ask() { return refused("sleep", "idle CPUs that do not sleep"); }

}  // namespace ebac::rt
