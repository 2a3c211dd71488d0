// Pictures during a run, for commands that compute a case in this process: --vtk DIR for ParaView, --watch FILE.html
// for any browser, --frames N for both, --contacts FILE.csv for the contacts of one instant.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/cli/parser.hpp"
#include "sweep/workers/compute.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace grainsweep::report {
class Film;
class VtkSeries;
}  // namespace grainsweep::report

namespace grainsweep::cli {

struct PictureRequest {
    std::string folder;  ///< of VTK files; empty: none
    std::string page;    ///< page with the film; empty: none
    std::optional<std::int64_t> frames;
    bool forces = false;      ///< the page has the normal forces of contacts
    std::string contacts;     ///< table of contacts; empty: none
    std::string contacts_at;  ///< its time; empty: the end

    [[nodiscard]] bool any() const { return !folder.empty() || !page.empty() || !contacts.empty(); }
};

void declare_pictures(Parser& parser, PictureRequest& request);

/// Pictures of one case. Throws InputError before the computation if the page cannot be written.
class Pictures {
public:
    Pictures(PictureRequest request, campaign::Case question);
    ~Pictures();

    /// Returns a camera for the requested pictures. At its first frame it throws InputError if the scene shows
    /// nothing, SystemError if a file cannot be written.
    [[nodiscard]] workers::Camera camera();
    /// Writes the page.
    void finish(const campaign::CaseResult& result);
    /// Prints which pictures were written, if any were requested; on standard error if standard output has one value
    /// for a program.
    void say(bool on_standard_output) const;

private:
    void shoot(const Scene& scene);
    void list_contacts(const Scene& scene);

    PictureRequest request_;
    campaign::Case question_;
    std::unique_ptr<report::VtkSeries> series_;
    std::unique_ptr<report::Film> film_;
    bool any_ = false;
    std::size_t page_bytes_ = 0;
    std::optional<double> contacts_at_;           // s
    std::optional<std::size_t> listed_contacts_;  // in the table
    double listed_at_ = 0;                        // s
};

}  // namespace grainsweep::cli
