// Contacts in the order of their partners, for probes that follow every contact from step to step.
#pragma once

#include "solver/dem/engine.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace grainsweep::machine {

/// Returns a number that orders contacts by the larger id, then by the smaller one; wall w counts as id -1 - w.
[[nodiscard]] inline std::uint64_t partner_key(std::int32_t a, std::int32_t b) {
    const auto raised = [](std::int32_t id) { return static_cast<std::uint32_t>(id) ^ 0x80000000U; };
    return std::uint64_t{raised(std::max(a, b))} << 32U | raised(std::min(a, b));
}

/// Sorts places of contacts; keeps its memory for the next step.
class PartnerOrder {
public:
    /// Returns the places ascending by partner_key; equal ones, several places on a wall, keep their order. Valid until
    /// the next call.
    [[nodiscard]] std::span<const std::uint32_t> of(const std::vector<dem::ContactForce>& contacts) {
        keyed_.clear();
        for (std::uint32_t place = 0; place < contacts.size(); ++place)
            keyed_.emplace_back(partner_key(contacts[place].first, contacts[place].second), place);
        std::ranges::sort(keyed_);
        places_.clear();
        for (const auto& [key, place] : keyed_) places_.push_back(place);
        return places_;
    }

private:
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed_;
    std::vector<std::uint32_t> places_;
};

}  // namespace grainsweep::machine
