// Interface by which a worker gets the answer of a case, from a simulation of the solver or from a program. Only the
// worker distinguishes the two.
#pragma once

#include "sweep/workers/message.hpp"

#include <optional>

namespace grainsweep::workers {

class Answerer {
public:
    Answerer() = default;
    Answerer(const Answerer&) = delete;
    Answerer& operator=(const Answerer&) = delete;
    virtual ~Answerer() = default;

    /// Looks for the checkpoint of an earlier attempt. Returns whether the case continues from it.
    [[nodiscard]] virtual bool prepare(const Run& run) = 0;
    /// Returns the answer of the case prepared last; empty if the case was interrupted because the worker must end.
    /// Throws BrokenWorld for an error that every other case would meet, too.
    [[nodiscard]] virtual std::optional<campaign::CaseResult> answer(const Run& run) = 0;
    /// Returns whether a checkpoint of the case is stored, which is useless once the case is answered.
    [[nodiscard]] virtual bool left_checkpoint() const = 0;
};

}  // namespace grainsweep::workers
