// The protocol between main program and worker, on one page.
//
// One JSON object per line, its members sorted by name, at most longest_line bytes, flushed. The main program writes
// Run, Threads, Lease, Stop to the worker's standard input; the worker writes Ready, Begun, Alive, Done, GiveBack to
// its standard output. End of file in either direction means that the other side is gone. Heartbeats stay short: some
// launchers delay lines above 1 kB.
//
//   main program
//          {"run":{"attempt":2,"id":"...","inputs":{...},"revision":1,"scene":"...","seed":7}}
//          {"threads":2}        threads of the present case, from its next slice on, and of later cases; at first 1
//          {"lease":true}       heartbeat; a worker without messages for too long gives back its cases and ends
//          {"stop":true}        no more cases; finish soon or give back, then end
//   worker
//          {"ready":{"build":"...","commit":"...","host":"...","path":"avx2",...,"protocol":3,"version":"..."}}
//          {"begun":{"attempt":2,"id":"...","resumed":false}}     the next of its cases
//          {"alive":{"attempt":2,"id":"...","progress":0.4}}      every second in which the case makes progress
//          {"done":{"attempt":2,"checkpointed":false,"cost":{...},"id":"...",...,"outcome":"completed"}}
//          {"give_back":{"attempt":2,"id":"...","reason":"..."}}  unfinished; a checkpoint may exist.
//                               With "broken":true: a file could not be written, as in every other case
//
// States of a worker in the main program (worker_state.hpp). An event without an arrow leads to `dismissed`:
//
//                      ready, of the same build
//       starting ------------------------------------> serving <--+ begun, alive, done
//          |  |  no message: a launcher's banner         |  |   | |   (one case at a time, in the order given)
//          |  +--> starting                              |  |   +-+
//          |                       give_back, or the     |  |
//          |                       stop was written      v  |
//          |   stop was written                    leaving <-- begun, alive, done, give_back
//          +--------------------------------------> |  |    |
//          |                                        |  |    |
//          | not ready in time;                     |  | no sign of life in time; no answer in time;
//          | another build or protocol;             |  | an answer to what it had not begun; no message;
//          | an answer before ready                 |  | a line too long; a flood
//          v                                        |  v    v
//       dismissed: killed; nothing it wrote counts  |  dismissed
//                                                   v
//       end of file, from any state: ended. What had begun has failed, or was interrupted from outside; the rest of
//       what it was given was never begun.
//
// States of a case given to a worker:
//
//       given --begun--> begun --done------> answered
//         |                |---give_back---> given back (abandoned; costs no try)
//         |                |---end of file-> crashed, or abandoned where it was ended from outside
//         |                +---dismissed---> crashed, timed_out, or abandoned where the worker fell silent
//         +--give_back---> given back
//         +--end of file, dismissed--> never begun: its attempt is free again
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::workers {

/// Number of the protocol; raised whenever a message changes its meaning.
inline constexpr std::int64_t protocol_number = 3;
/// Largest number of bytes of a line. A million samples of a series do not fit. A worker reports a case that does not
/// fit as `rejected`.
inline constexpr std::size_t longest_line = std::size_t{16} << 20U;

/// Largest number of threads of one case.
inline constexpr std::int64_t most_threads = 4096;

struct Run {
    static constexpr std::string_view word = "run";
    std::int64_t attempt = 1;
    campaign::Case question;
};
struct Threads {
    static constexpr std::string_view word = "threads";
    std::int64_t count = 1;
};
struct Lease {
    static constexpr std::string_view word = "lease";
    bool set = true;
};
struct Stop {
    static constexpr std::string_view word = "stop";
    bool set = true;
};
using ToWorker = std::variant<Run, Threads, Lease, Stop>;

struct Ready {
    static constexpr std::string_view word = "ready";
    std::int64_t protocol = protocol_number;
    campaign::Computer computer;
};
struct Begun {
    static constexpr std::string_view word = "begun";
    campaign::Attempt attempt;
    bool resumed = false;  ///< the case continues from a checkpoint
};
struct Alive {
    static constexpr std::string_view word = "alive";
    campaign::Attempt attempt;
    double progress = 0;  ///< 0 to 1; NaN: not known yet
};
struct Done {
    static constexpr std::string_view word = "done";
    campaign::CaseResult result;
    bool checkpointed = false;  ///< a checkpoint file of the case exists and may now be removed
};
struct GiveBack {
    static constexpr std::string_view word = "give_back";
    campaign::Attempt attempt;
    std::string reason;
    bool broken = false;  ///< a file could not be written: the run ends
};
using ToBoss = std::variant<Ready, Begun, Alive, Done, GiveBack>;

/// Returns the message as one line without its line end. Numbers keep all their bits; NaN becomes null.
[[nodiscard]] std::string encode(const ToWorker& message);
[[nodiscard]] std::string encode(const ToBoss& message);
/// Returns the message of a line. Throws std::invalid_argument if the line is no message.
[[nodiscard]] ToWorker decode_to_worker(std::string_view line);
[[nodiscard]] ToBoss decode_to_boss(std::string_view line);

}  // namespace grainsweep::workers
