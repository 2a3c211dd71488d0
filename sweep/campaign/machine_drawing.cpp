#include "sweep/campaign/machine_drawing.hpp"

#include "sweep/campaign/input_error.hpp"

#include "solver/machine/drawing.hpp"

#include <stdexcept>

namespace grainsweep::campaign {

std::string draw_machine(const Machine& machine, const Inputs& inputs, std::int64_t frames,
                         const std::function<void(const Snapshot&, double time)>& show) {
    const auto spec = machine_spec(machine, inputs);
    std::string why_empty;
    machine::Filled filled;
    try {
        filled = machine::filled(spec, 1);
    } catch (const std::invalid_argument& why) {
        why_empty = why.what();
    }
    try {
        const double end = machine::longest_time(spec);
        for (std::int64_t k = 0; k < frames; ++k) {
            const double time = end * static_cast<double>(k) / static_cast<double>(frames - 1);
            show(machine::drawing(spec, filled, time), time);
        }
    } catch (const std::invalid_argument& why) {
        throw InputError(machine.name + ": " + why.what());
    }
    return why_empty;
}

}  // namespace grainsweep::campaign
