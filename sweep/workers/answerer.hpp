// What a worker asks for the answer of a case: a simulation of the solver, or a program. Nothing above the worker knows
// which it is.
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

    /// Looks for what an earlier attempt left; whether the case goes on from there.
    [[nodiscard]] virtual bool prepare(const Run& run) = 0;
    /// Answers the case prepared last; nothing where it was given up because the worker is to end. Throws BrokenWorld
    /// where no other case would fare better.
    [[nodiscard]] virtual std::optional<campaign::CaseResult> answer(const Run& run) = 0;
    /// Whether a state of the case is saved that is of no use once it is answered.
    [[nodiscard]] virtual bool left_checkpoint() const = 0;
};

}  // namespace grainsweep::workers
