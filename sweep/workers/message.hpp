// The protocol between boss and worker, on one page.
//
// One JSON object per line, flushed. The boss writes Run, Lease, Stop to the worker's standard input; the
// worker writes Ready, Alive, Done, Parked to its standard output. End of file in either direction means
// the other side is gone. Heartbeats stay short: some launchers delay lines above 1 kB.
//
//   boss   {"run": {"attempt": 2, "id": "...", "scene": "...", "revision": 1, "seed": 7, "inputs": {...}}}
//          {"lease": true}      the boss lives; a worker that hears nothing for a minute exits
//          {"stop": true}       no more cases; finish soon or park at a checkpoint, then exit
//   worker {"ready": {"version": "...", "path": "avx2"}}
//          {"alive": {"id": "...", "attempt": 2, "progress": 0.4}}
//          {"done": {"id": "...", "attempt": 2, "outcome": "completed", ...}}
//          {"parked": {"id": "...", "attempt": 2}}     given back unfinished; a checkpoint may exist
#pragma once

#include "sweep/campaign/case.hpp"

#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::workers {

struct Run {
    std::int64_t attempt = 1;
    campaign::Case question;
};
struct Lease {};
struct Stop {};
using ToWorker = std::variant<Run, Lease, Stop>;

struct Ready {
    std::string version;           ///< commit and build of the worker's executable
    std::string instruction_path;  ///< what its inner loops run with
};
struct Alive {
    campaign::Attempt attempt;
    double progress = 0;
};
struct Done {
    campaign::CaseResult result;
    bool checkpointed = false;  ///< a checkpoint file of the case exists and may now be removed
};
struct Parked {
    campaign::Attempt attempt;
};
using ToBoss = std::variant<Ready, Alive, Done, Parked>;

/// One line without its end. Numbers round-trip; NaN travels as null.
[[nodiscard]] std::string encode(const ToWorker& message);
[[nodiscard]] std::string encode(const ToBoss& message);
/// Throws std::invalid_argument on anything that is not a message.
[[nodiscard]] ToWorker decode_to_worker(std::string_view line);
[[nodiscard]] ToBoss decode_to_boss(std::string_view line);

}  // namespace grainsweep::workers
