#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace grainsweep::tests {

using nlohmann::json;

json small_machine() {
    return json::parse(R"({
      "name": "bin",
      "parameters": {
        "friction": {"default": 0.4, "bounds": [0, 2], "meaning": "of all contacts"},
        "speed": {"unit": "rpm", "default": "60 rpm", "bounds": ["1 rpm", "600 rpm"], "meaning": "of the paddle"},
        "bars": {"whole": true, "default": 1, "bounds": [0, 3]},
        "kind": {"words": ["coarse", "fine"], "default": "coarse"}
      },
      "let": {"side": "20 mm", "half": "side/2", "of_fine": "kind_is_fine"},
      "materials": {
        "glass": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25},
        "steel": {"density": 7800, "youngs_modulus": "5 MPa", "poisson_ratio": 0.3}
      },
      "contacts": {"restitution": 0.5, "friction": "friction", "pairs": {"glass steel": {"friction": 0.3}}},
      "species": {
        "light": {"material": "glass", "diameter": "3 mm"},
        "heavy": {"material": "steel", "diameter": "2.5 mm", "sizes": {"spread": "uniform", "half_width": 0.1}}
      },
      "walls": {
        "box": {"box": {"low": [0, 0, 0], "high": ["side", "side", "2*side"], "open": ["+z"]}, "material": "steel"},
        "paddle": {"rectangle": {"corner": ["half - 0.002", "half", 0.001], "along": [0.004, 0, 0],
                                 "across": [0, 0, 0.01]}, "material": "steel", "repeat": "bars", "as": "k",
                   "motion": [{"rotate": {"axis": [0, 0, 1], "through": ["half", "half", 0], "speed": "speed"},
                               "from": "turn"}]},
        "lid": {"plane": {"point": [0, 0, "2*side"], "normal": [0, 0, -1]}, "material": "glass", "during": ["fall"]}
      },
      "fill": [{"mix": {"light": 0.5, "heavy": 0.5}, "by": "count", "count": 20, "shaken": 0.05,
                "in": {"box": {"low": [0, 0, 0.012], "high": ["side", "side", 0.03]}}}],
      "feed": [{"species": "light", "rate": "2 g/s", "velocity": [0, 0, -0.5], "every": 0.01, "during": ["turn"],
                "through": {"cylinder": {"base": ["half", "half", 0.025], "radius": 0.008, "length": 0.01}}}],
      "phases": [{"name": "fall", "until": {"at_rest": true}, "at_most": 0.05, "frames": 3},
                 {"name": "turn", "for": 0.05, "frames": 10},
                 {"name": "stop", "for": 0.02, "frames": 2}],
      "measure": {
        "mixing": {"lacey": {"of": ["light", "heavy"], "cell": "5 mm", "least": 0.01}, "as": "series"},
        "force": {"wall_force": {"wall": "box", "along": [0, 0, 1]}, "during": "turn"},
        "torque": {"wall_torque": {"wall": "paddle", "axis": [0, 0, 1], "about": ["half", "half", 0]},
                   "during": ["turn", "stop"]},
        "passed": {"passed_mass": {"point": [0, 0, 0.01], "normal": [0, 0, -1]}, "as": "last"},
        "layers": {"profile": {"along": [0, 0, 1], "from": 0, "to": 0.02, "bins": 5}, "during": "stop"},
        "low": {"mean_height": {}, "as": "last"},
        "sunk": {"time_of": "heights", "below": 0.015},
        "heights": {"mean_height": {}, "as": "series"},
        "power": "torque*speed"
      }
    })");
}

std::shared_ptr<const campaign::Machine> machine_of(const json& document, const FileTexts& files) {
    return campaign::make_machine(document, "$", [&](const std::string& name) {
        const auto found = files.find(name);
        if (found == files.end()) throw std::invalid_argument("there is no file " + name);
        return found->second;
    });
}

Inputs inputs_of(const campaign::Machine& machine, const Inputs& chosen) {
    Inputs inputs;
    for (const auto& parameter : machine.parameters) inputs.emplace(parameter.name, parameter.default_value);
    for (const auto& [name, value] : chosen) inputs.insert_or_assign(name, value);
    return inputs;
}

machine::Spec spec_of(const json& document, const Inputs& chosen, const FileTexts& files) {
    const auto machine = machine_of(document, files);
    return campaign::machine_spec(*machine, inputs_of(*machine, chosen));
}

Observations answer_of(const machine::Spec& spec, std::uint64_t seed) {
    machine::Run run(spec, seed);
    run.advance(1e9);
    Observations observations;
    run.observe(observations);
    return observations;
}

void expect_same_resumed(const json& document, double time) {
    for (const char* precision : {"double", "mixed"}) {
        const auto spec = spec_of(document, {{"precision", precision}});
        machine::Run first(spec, 1), second(spec, 1);
        first.advance(time);
        std::vector<std::byte> saved;
        first.save(saved);
        second.restore(saved);
        second.advance(1e9);
        Observations observations;
        second.observe(observations);
        EXPECT_EQ(text_of(observations), text_of(answer_of(spec))) << precision;
    }
}

std::string text_of(const Observations& observations) {
    std::string text;
    const auto put = [&](double value) {
        std::array<char, 40> digits{};
        std::snprintf(digits.data(), digits.size(), " %a", value);
        text += digits.data();
    };
    for (const auto& [name, value] : observations.scalars) text += name, put(value), text += "\n";
    for (const auto& [name, samples] : observations.series) {
        text += name;
        for (const auto& sample : samples) put(sample.time), put(sample.bin), put(sample.value);
        text += "\n";
    }
    return text;
}

}  // namespace grainsweep::tests
