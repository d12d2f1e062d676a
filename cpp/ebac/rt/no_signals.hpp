#pragma once

#ifndef EBAC_PORTABLE
#include <pthread.h>

#include <csignal>
#endif

namespace ebac::rt {

/// Blocks signals for the calling thread, and the threads it starts, for as long as this lives.
class NoSignals {
 public:
#ifdef EBAC_PORTABLE
  NoSignals() noexcept {
  }  // NOLINT(modernize-use-equals-default): or it would be an unused variable
#else
  NoSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~NoSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
#endif
  NoSignals(const NoSignals&) = delete;
  NoSignals& operator=(const NoSignals&) = delete;
  NoSignals(NoSignals&&) = delete;
  NoSignals& operator=(NoSignals&&) = delete;

#ifndef EBAC_PORTABLE
 private:
  sigset_t before_{};
#endif
};

}  // namespace ebac::rt
