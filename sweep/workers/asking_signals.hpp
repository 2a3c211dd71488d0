// Signals by which systems request the end of a process.
#pragma once

#include <array>
#include <csignal>
#include <functional>

namespace grainsweep::workers {

inline constexpr std::array asking_signals = {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2};

/// Blocks these signals so that attend() receives them. Call it before any other thread starts.
void hold_asking_signals();
/// Calls `asked` for every such signal, and `tick` every second. Counts the seconds itself instead of reading a clock.
/// While this process is stopped (Ctrl-Z, a suspended machine) it cannot receive messages, and its main program is
/// stopped too.
[[noreturn]] void attend(const std::function<void(int signal)>& asked, const std::function<void()>& tick);

}  // namespace grainsweep::workers
