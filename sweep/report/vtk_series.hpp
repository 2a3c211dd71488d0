// A scene as it goes, for ParaView and everything else that reads VTK: files of single moments (vtk_file.hpp), and a
// PVD file that says when each of them is.
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

    /// Writes the files of the moment, then NAME.pvd anew, which names all so far. Particles are NAME_0000.vtp,
    /// NAME_0001.vtp, ...; a flow is NAME_FIELD_0000.vti or .vtr. A wall is NAME_WALL_0000.vtp, numbered by the moment
    /// since which it has not moved: one that never moves is one file. Makes the folder where there is none; the
    /// first moment takes away an older series of this name. Throws BrokenWorld where it cannot.
    void add(const Snapshot& snapshot, double time);
    [[nodiscard]] std::size_t size() const { return moments_; }
    [[nodiscard]] std::filesystem::path collection() const { return folder_ / (name_ + ".pvd"); }

private:
    struct Wall {
        WallSurface shown;
        std::string file;
    };

    void begin();
    [[nodiscard]] std::string file_of(std::string_view what, std::string_view extension) const;
    void list(std::string_view what, const std::string& file, double time);

    std::filesystem::path folder_;
    std::string name_;
    std::size_t moments_ = 0;
    std::map<std::string, Wall, std::less<>> walls_;
    std::vector<std::string> parts_;  ///< names, in the order of their numbers
    std::string entries_;             ///< of the collection
};

}  // namespace grainsweep::report
