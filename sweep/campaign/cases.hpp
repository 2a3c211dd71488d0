// Cases of a campaign in the order of its design. Only places and ids are stored, 36 bytes per case, beside the
// coordinates of the points. A case itself is computed from its point on request.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::campaign {

/// Place of a case in a design, which has fewer than 2^28 points.
struct Place {
    std::uint32_t point = 0, sequence = 0, replicate = 0;
    auto operator<=>(const Place&) const = default;
};

/// Interface that makes the cases at the places of a list.
class Questions {
public:
    Questions() = default;
    Questions(const Questions&) = delete;
    Questions& operator=(const Questions&) = delete;
    virtual ~Questions() = default;
    /// Makes the case at place i. Inputs that `into` has from an earlier call, and that do not vary, do not change.
    virtual void make(std::size_t i, const Place& place, Case& into) const = 0;
    /// Makes only its inputs, in the same way.
    virtual void make_inputs(std::size_t i, const Place& place, Inputs& into) const = 0;
};

/// List of cases. Copies share their columns, which never change, so several threads may read them.
class Cases {
public:
    Cases() : Cases(std::span<const PlacedCase>()) {}
    /// Takes existing cases.
    Cases(std::span<const PlacedCase> listed);    // NOLINT(google-explicit-constructor)
    Cases(const std::vector<PlacedCase>& listed)  // NOLINT(google-explicit-constructor)
        : Cases(std::span<const PlacedCase>(listed)) {}
    /// `hashes`: ids of the cases, place by place.
    Cases(std::vector<Place> places, std::vector<CaseHash> hashes, std::shared_ptr<const Questions> questions);

    [[nodiscard]] std::size_t size() const { return columns_->places.size(); }
    [[nodiscard]] bool empty() const { return size() == 0; }
    [[nodiscard]] const Place& place(std::size_t i) const { return columns_->places[i]; }
    [[nodiscard]] const CaseHash& hash(std::size_t i) const { return columns_->hashes[i]; }
    [[nodiscard]] CaseId id(std::size_t i) const;
    [[nodiscard]] Case question(std::size_t i) const;
    /// Write the case, or its inputs, into an object that is empty or that this list filled before.
    void question(std::size_t i, Case& into) const { columns_->questions->make(i, place(i), into); }
    void inputs(std::size_t i, Inputs& into) const { columns_->questions->make_inputs(i, place(i), into); }
    [[nodiscard]] PlacedCase operator[](std::size_t i) const;

    /// Returns the first place with the case of this id.
    [[nodiscard]] std::optional<std::size_t> find(const CaseHash& hash) const;
    /// Returns the next place with the same case as place i.
    [[nodiscard]] std::optional<std::size_t> next(std::size_t i) const;
    /// Returns the first place with the same case as place i.
    [[nodiscard]] std::size_t first(std::size_t i) const { return columns_->next.empty() ? i : *find(hash(i)); }
    /// Returns whether no place before i has the same case.
    [[nodiscard]] bool is_first(std::size_t i) const { return first(i) == i; }

    class Iterator {
    public:
        using difference_type = std::ptrdiff_t;
        using value_type = PlacedCase;
        Iterator() = default;
        Iterator(const Cases* cases, std::size_t at) : cases_(cases), at_(at) {}
        PlacedCase operator*() const { return (*cases_)[at_]; }
        Iterator& operator++() {
            ++at_;
            return *this;
        }
        Iterator operator++(int) {
            Iterator before = *this;
            ++at_;
            return before;
        }
        bool operator==(const Iterator&) const = default;

    private:
        const Cases* cases_ = nullptr;
        std::size_t at_ = 0;
    };
    [[nodiscard]] Iterator begin() const { return {this, 0}; }
    [[nodiscard]] Iterator end() const { return {this, size()}; }

private:
    struct Columns {
        std::vector<Place> places;
        std::vector<CaseHash> hashes;
        std::vector<std::uint32_t> slots;  ///< hash table of place numbers plus 1; 0: free
        std::vector<std::uint32_t> next;   ///< next place with the same id, plus 1; empty: no case is repeated
        std::shared_ptr<const Questions> questions;
        void fill_table();
        [[nodiscard]] std::size_t slot_of(const CaseHash& hash) const;
    };
    std::shared_ptr<const Columns> columns_;
};

}  // namespace grainsweep::campaign
