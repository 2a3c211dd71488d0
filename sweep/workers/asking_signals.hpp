// The signals by which systems ask a process to end.
#pragma once

#include <array>
#include <csignal>
#include <functional>

namespace grainsweep::workers {

inline constexpr std::array asking_signals = {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2};

/// Keeps them for attend(): to be called before there is another thread.
void hold_asking_signals();
/// Calls `asked` for every one that comes, and `tick` every second. Counts seconds and looks at no clock of the day: a
/// process that is stopped (Ctrl-Z, a suspended machine) could not hear its main program, which was stopped with it.
[[noreturn]] void attend(const std::function<void(int signal)>& asked, const std::function<void()>& tick);

}  // namespace grainsweep::workers
