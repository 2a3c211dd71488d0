// Points the user wrote down: rows of physical values, taken as they are.
#include "sweep/designs/kinds.hpp"

#include <stdexcept>

namespace grainsweep::designs {
namespace {

const Rows& rows_of(const DesignRequest& request) {
    const auto found = request.options.find("rows");
    const Rows* rows = found == request.options.end() ? nullptr : std::get_if<Rows>(&found->second);
    if (rows == nullptr || rows->empty()) throw std::invalid_argument("a list design needs at least one row");
    return *rows;
}

PointSet listed_points(const DesignRequest& request) {
    const Rows& rows = rows_of(request);
    for (std::size_t p = 0; p < rows.size(); ++p) {
        const std::size_t width = rows[p].size();
        if (width != request.dimensions())
            throw std::invalid_argument("row " + std::to_string(p + 1) + " of the list has " + std::to_string(width) +
                                        (width == 1 ? " value" : " values") + "; there are " +
                                        std::to_string(request.dimensions()) + " factors");
    }
    return {.dimensions = request.dimensions(), .sequences = 1, .coordinates = {}, .rows = rows};
}

}  // namespace

DesignInfo list_design() {
    return {.name = "list",
            .summary =
                "The rows you give, in physical values, one column a factor: validation series, corner cases, "
                "points of another program. Statistics over a list describe the list, not the ranges.",
            .other_names = {"csv", "table", "custom"},
            .options = {{{"rows", Field::Kind::array,
                          "rows of values, one a factor in the order of 'factors'; or give \"file\": a CSV beside the "
                          "campaign file"},
                         true}},
            .extends = true,
            .beginning = Beginning::listed,
            .size = [](const DesignRequest& request) { return static_cast<std::int64_t>(rows_of(request).size()); },
            .sample = listed_points};
}

}  // namespace grainsweep::designs
