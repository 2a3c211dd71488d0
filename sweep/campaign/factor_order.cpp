// The order of the factors in a campaign file determines the dimensions of the design, but is no part of the campaign's
// identity. A stored campaign keeps its first order.
#include "sweep/campaign/campaign.hpp"

#include <algorithm>
#include <utility>

namespace grainsweep::campaign {

namespace {

/// items[places[0]], items[places[1]], ...
template <class Item>
void permute(std::vector<Item>& items, std::span<const std::size_t> places) {
    std::vector<Item> sorted;
    sorted.reserve(items.size());
    for (const std::size_t place : places) sorted.push_back(std::move(items[place]));
    items = std::move(sorted);
}

void permute(designs::OptionValue& value, std::span<const std::size_t> places) {
    if (auto* counts = std::get_if<std::vector<std::int64_t>>(&value); counts != nullptr && !counts->empty())
        permute(*counts, places);
    if (auto* rows = std::get_if<designs::Rows>(&value))
        for (auto& row : *rows) permute(row, places);
}

}  // namespace

bool reorder_factors(Campaign& campaign, std::span<const std::string> order) {
    auto& factors = campaign.space.factors;
    if (order.size() != factors.size() || std::ranges::equal(order, factors, {}, {}, &Factor::name)) return false;
    std::vector<std::size_t> places;
    for (const auto& name : order) {
        const auto found = std::ranges::find(factors, name, &Factor::name);
        if (found == factors.end()) return false;
        places.push_back(static_cast<std::size_t>(found - factors.begin()));
    }
    permute(factors, places);
    permute(campaign.request.levels, places);
    if (!campaign.request.groups.empty()) campaign.request.groups = groups_of(factors);
    if (!campaign.request.factors.empty()) permute(campaign.request.factors, places);
    for (auto& [name, value] : campaign.request.options) permute(value, places);
    return true;
}

std::string factor_list(const ParameterSpace& space) {
    std::string list;
    for (const auto& factor : space.factors) list += (list.empty() ? "" : ", ") + factor.name;
    return list;
}

}  // namespace grainsweep::campaign
