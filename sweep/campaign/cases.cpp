#include "sweep/campaign/cases.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

namespace grainsweep::campaign {

namespace {

class Listed final : public Questions {
public:
    explicit Listed(std::span<const PlacedCase> cases) : cases_(cases.begin(), cases.end()) {}
    void make(std::size_t i, const Place&, Case& into) const override { into = cases_[i].question; }
    void make_inputs(std::size_t i, const Place&, Inputs& into) const override { into = cases_[i].question.inputs; }

private:
    std::vector<PlacedCase> cases_;
};

}  // namespace

std::size_t Cases::Columns::slot_of(const CaseHash& hash) const {
    const std::size_t mask = slots.size() - 1;
    std::size_t slot = hash.low & mask;  // ids are hashes already
    while (slots[slot] != 0 && hashes[slots[slot] - 1] != hash) slot = (slot + 1) & mask;
    return slot;
}

void Cases::Columns::fill_table() {
    slots.assign(std::bit_ceil(2 * hashes.size() + 1), 0);
    std::vector<std::uint32_t> last;  // place of each id, as far as some stand twice
    for (std::size_t i = 0; i < hashes.size(); ++i) {
        auto& slot = slots[slot_of(hashes[i])];
        const auto number = static_cast<std::uint32_t>(i + 1);
        if (slot == 0) {
            slot = number;
            continue;
        }
        if (next.empty()) {
            next.assign(hashes.size(), 0);
            last.assign(hashes.size(), 0);
        }
        auto& end = last[slot - 1];
        next[(end == 0 ? slot : end) - 1] = number;
        end = number;
    }
}

Cases::Cases(std::span<const PlacedCase> listed) {
    auto columns = std::make_shared<Columns>();
    for (const auto& one : listed) {
        columns->places.push_back({static_cast<std::uint32_t>(one.point), static_cast<std::uint32_t>(one.sequence),
                                   static_cast<std::uint32_t>(one.replicate)});
        columns->hashes.push_back(hash_of(one.question.id));
    }
    columns->questions = std::make_shared<const Listed>(listed);
    columns->fill_table();
    columns_ = std::move(columns);
}

Cases::Cases(std::vector<Place> places, std::vector<CaseHash> hashes, std::shared_ptr<const Questions> questions) {
    assert(places.size() == hashes.size());
    auto columns = std::make_shared<Columns>();
    columns->places = std::move(places);
    columns->hashes = std::move(hashes);
    columns->questions = std::move(questions);
    columns->fill_table();
    columns_ = std::move(columns);
}

CaseId Cases::id(std::size_t i) const {
    return id_of(hash(i));
}

Case Cases::question(std::size_t i) const {
    Case made;
    question(i, made);
    return made;
}

PlacedCase Cases::operator[](std::size_t i) const {
    const auto& [point, sequence, replicate] = place(i);
    return {question(i), point, sequence, replicate};
}

std::optional<std::size_t> Cases::find(const CaseHash& hash) const {
    const std::uint32_t found = columns_->slots[columns_->slot_of(hash)];
    return found == 0 ? std::nullopt : std::optional<std::size_t>(found - 1);
}

std::optional<std::size_t> Cases::next(std::size_t i) const {
    const std::uint32_t found = columns_->next.empty() ? 0 : columns_->next[i];
    return found == 0 ? std::nullopt : std::optional<std::size_t>(found - 1);
}

}  // namespace grainsweep::campaign
