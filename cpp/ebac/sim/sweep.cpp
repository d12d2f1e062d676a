#include "ebac/sim/sweep.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>

namespace ebac {

void for_each_run(std::size_t count, int threads, SweepProgress& progress, const SweepWork& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex raising;
  std::exception_ptr raised;
  const auto run = [&] {
    try {
      ContactRecorder recorder;
      for (std::size_t i = next++; i < count && !progress.cancelled; i = next++) {
        work(i, recorder);
        if (!progress.cancelled) ++progress.done;
      }
    } catch (...) {
      const std::scoped_lock lock(raising);
      if (!raised) raised = std::current_exception();
      progress.cancelled = true;
    }
  };
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  const int wanted = threads > 0 ? threads : std::max(1, cores);
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < wanted && static_cast<std::size_t>(i) < count; ++i)
      others.emplace_back(run);
    run();
  }
  if (raised) std::rethrow_exception(raised);
}

}  // namespace ebac
