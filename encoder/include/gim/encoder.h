// gim::encoder: triangle mesh in, .gim file out. C++20. Nothing here throws, prints or exits; failures come back as Error.
// All functions are pure: same input, options and seed give the same result at any thread count.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gim {

// Where the encoder was when it failed. `stage_name` gives the word that messages use.
enum class Stage { kInput, kClean, kCut, kBoundaryMap, kParametrize, kSample, kFit, kCode, kWrite, kCompare };
std::string_view stage_name(Stage stage);

struct Error {
    Stage stage = Stage::kInput;
    std::string message;  // one or more lines: the element, what is wrong with it, what to do
};

// A value or an Error. Asking for the one that is not there is a programming error.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}

    bool ok() const { return std::holds_alternative<T>(state_); }
    T& value() { return std::get<T>(state_); }
    const T& value() const { return std::get<T>(state_); }
    const Error& error() const { return std::get<Error>(state_); }

  private:
    std::variant<T, Error> state_;
};

// Triangle soup or mesh as read from a file. Triangles index into `positions`; coordinates in any unit.
struct TriangleMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
};

// Called at the start of each stage and during long ones. `fraction` is 0..1 within the stage. Never called concurrently.
using Progress = std::function<void(Stage stage, double fraction)>;

// ---- comparing -------------------------------------------------------------------------------------------------------

struct CompareOptions {
    uint32_t samples = 500000;  // area-stratified samples per direction, besides the vertices for the Hausdorff distance
    uint64_t seed = 1;          // same seed, same figures
    uint32_t threads = 0;       // 0: all cores; the result does not depend on it
};

// Distances are in the meshes' own unit. Cost O((|A|+|B|+samples) log) with a bounding-volume hierarchy.
struct Comparison {
    double diagonal = 0;           // bounding-box diagonal of the reference
    double rms_to_test = 0;        // area-weighted RMS distance, reference -> test surface
    double rms_to_reference = 0;   // test -> reference surface
    double rms = 0;                // the larger of the two
    double max_to_test = 0;        // largest sampled distance each way
    double max_to_reference = 0;
    double hausdorff = 0;          // the larger of the two
    double psnr = 0;               // 20 log10(diagonal / rms); infinity when rms is 0
};
Result<Comparison> compare(const TriangleMesh& reference, const TriangleMesh& test, const CompareOptions& options);

// What holds of a mesh's connectivity, by its indices (vertices at equal positions are not merged).
struct TopologySummary {
    uint64_t vertices = 0, edges = 0, triangles = 0;  // referenced vertices only
    uint64_t components = 0;                          // pieces connected through edges
    uint64_t boundary_loops = 0;
    int64_t euler = 0;                                // V - E + F
    double genus = 0;                                 // summed over components; not a number when not a manifold
    uint64_t boundary_edges = 0;
    uint64_t nonmanifold_edges = 0, nonmanifold_vertices = 0;
    uint64_t misoriented_edges = 0;                   // two faces that run the same way along their common edge
    bool manifold = false;                            // no non-manifold edge or vertex, oriented
    bool watertight = false;                          // manifold without boundary
};
TopologySummary summarize_topology(const TriangleMesh& mesh);

}  // namespace gim
