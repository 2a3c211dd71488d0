// Time series of a scene for ParaView and other readers of VTK: files of single moments (vtk_file.hpp), and a PVD file
// with their times.
#pragma once

#include "solver/scenes/values.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

class VtkSeries {
public:
    VtkSeries(std::filesystem::path folder, std::string name);

    /// Writes the files of the moment, and NAME.pvd, which names all files so far. Particles are in NAME_0000.vtp,
    /// NAME_0001.vtp, ...; their contacts in NAME_0000_contacts.vtp; a flow is in NAME_FIELD_0000.vti or .vtr. A wall
    /// is in NAME_WALL_0000.vtp, with the number of its last movement, so a fixed wall needs one file. Makes the folder
    /// if there is none; the first moment removes an older series of this name. Throws SystemError on failure.
    void add(const Snapshot& snapshot, double time);
    /// Keeps only these moments, and removes the files that no other one needs; indices in ascending order.
    void keep(const std::vector<std::size_t>& moments);
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    [[nodiscard]] std::filesystem::path collection() const { return folder_ / (name_ + ".pvd"); }

private:
    struct Wall {
        WallSurface shown;
        std::string file;
    };

    void begin();
    [[nodiscard]] std::string file_of(std::string_view what, std::string_view extension) const;
    void list(std::string_view what, const std::string& file);
    void write_collection() const;

    std::filesystem::path folder_;
    std::string name_;
    std::size_t written_ = 0;  ///< moments so far, also those not kept
    std::map<std::string, Wall, std::less<>> walls_;
    std::vector<std::string> parts_;  ///< names, in the order of their numbers
    struct Moment {
        double time = 0;
        std::vector<std::pair<std::size_t, std::string>> files;  ///< part and name
    };
    std::vector<Moment> entries_;
};

}  // namespace grainsweep::report
