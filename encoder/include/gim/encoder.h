// gim::encoder: triangle mesh in, .gim file out. C++20. Nothing here throws, prints or exits; failures come back as Error.
// All functions are pure: same input, options and seed give the same result at any thread count.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gim {

// Every change that changes the bytes of any file raises this. Rows of older coders in corpus/results.csv are then
// measured again.
inline constexpr uint32_t kCoderVersion = 1;

// Where the encoder was when it failed. `stage_name` gives the word that messages use.
enum class Stage { kInput, kClean, kCut, kBoundaryMap, kParametrize, kSample, kFit, kPlanes, kCode, kWrite, kCompare };
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

// Success or an Error.
template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    bool ok() const { return !error_; }
    const Error& error() const { return *error_; }

  private:
    std::optional<Error> error_;
};

struct TextureImage {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;  // 3 * width * height, sRGB, row-major, top row first
};

// Colours of a mesh, per triangle and corner, so that seams of a texture need no extra vertices. Each array is empty or has
// one entry per triangle. A point's colour is its texture's times its corner colours'; white where there is neither.
struct Appearance {
    std::vector<std::array<std::array<float, 3>, 3>> corner_colors;     // sRGB, 0..1
    std::vector<std::array<std::array<float, 2>, 3>> corner_texcoords;  // u, v: 0 0 is the top left corner of the
                                                                        // texture, 1 1 the bottom right one; it repeats
    std::vector<uint32_t> triangle_texture;                             // index into textures; UINT32_MAX: none
    std::vector<TextureImage> textures;

    bool empty() const { return corner_colors.empty() && (textures.empty() || triangle_texture.empty()); }
};

// Triangle soup or mesh as read from a file. Triangles index into `positions`; coordinates in any unit.
struct TriangleMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    Appearance appearance = {};
};

// Called at the start of each stage and during long ones. `fraction` is 0..1 within the stage. Never called concurrently.
using Progress = std::function<void(Stage stage, double fraction)>;

// ---- comparing -------------------------------------------------------------------------------------------------------

struct CompareOptions {
    uint32_t samples =
        500000;            // area-stratified samples per direction, besides the vertices for the Hausdorff distance
    uint64_t seed = 1;     // same seed, same figures
    uint32_t threads = 0;  // 0: all cores; the result does not depend on it
    bool normals = false;  // Comparison::normals too; about a fifth more time
};

// Mean angle in degrees between the shading normals of a sample and of the point nearest to it on the other surface. Each
// surface's shading normals are its own: interpolated linearly between vertex normals, which are the area-weighted means of
// the triangles around all vertices at one position. Where a surface has none (zero area), 90 degrees count.
struct NormalError {
    double to_test = 0, to_reference = 0;  // samples on the reference, on the test surface
    double mean = 0;                       // of the two
};

// Distances are in the meshes' own unit. Cost O((|A|+|B|+samples) log) with a bounding-volume hierarchy.
struct Comparison {
    double diagonal = 0;          // bounding-box diagonal of the reference
    double rms_to_test = 0;       // area-weighted RMS distance, reference -> test surface
    double rms_to_reference = 0;  // test -> reference surface
    double rms = 0;               // the larger of the two
    double max_to_test = 0;       // largest sampled distance each way
    double max_to_reference = 0;
    double hausdorff = 0;                     // the larger of the two
    double psnr = 0;                          // 20 log10(diagonal / rms); infinity when rms is 0
    std::optional<NormalError> normals = {};  // where CompareOptions::normals asks for it
};
Result<Comparison> compare(const TriangleMesh& reference, const TriangleMesh& test, const CompareOptions& options);

// What holds of a mesh's connectivity, by its indices (vertices at equal positions are not merged).
struct TopologySummary {
    uint64_t vertices = 0, edges = 0, triangles = 0;  // referenced vertices only
    uint64_t components = 0;                          // pieces connected through edges
    uint64_t boundary_loops = 0;
    int64_t euler = 0;  // V - E + F
    double genus = 0;   // summed over components; not a number when not a manifold
    uint64_t boundary_edges = 0;
    uint64_t nonmanifold_edges = 0, nonmanifold_vertices = 0;
    uint64_t misoriented_edges = 0;  // two faces that run the same way along their common edge
    bool manifold = false;           // no non-manifold edge or vertex, oriented
    bool watertight = false;         // manifold without boundary
};
TopologySummary summarize_topology(const TriangleMesh& mesh);

// ---- encoding --------------------------------------------------------------------------------------------------------

enum class Layout { kGim, kMcgim, kTiles, kAuto };

// How many bits the samples get.
struct RateTarget {
    enum class Kind {
        kLossless,  // the decoded image equals the quantized image
        kPsnr,      // value: dB, decoded surface against the input mesh; never below it
        kBytes,     // value: size of the whole file; never above it
        kQuality,   // value: 0 (smallest) .. 100 (finest); 10 more halve the quantizer step
    };
    Kind kind = Kind::kQuality;
    double value = 75;
};

// How far the samples may move to bring the image's surface nearer to the input.
enum class FitStrength {
    kAuto,  // loose for lossless coding, stiff for the rest; lossy squares are then fitted to their quantizer, which makes
            // files of the same error smaller by a fifth and more
    kOff,    // plain samples
    kStiff,  // samples hardly slide along the surface, so the bytes hardly grow; about +4 dB
    kLoose,  // samples find the surface's creases; about +9 dB, and much more tangential detail
};

struct EncodeOptions {
    Layout layout = Layout::kGim;
    uint32_t side = 257;  // samples per side of the square, 2^j + 1; doubling it costs 4x time and memory.
                          // Of several components the largest gets it, the others less, by their area
    // kGim with a target of PSNR or bytes: where that is coarse, also codes images of half the side, and so on as long as
    // that is better, and keeps the best file. About 1.5 times the time. The cut is chosen at the first half.
    bool try_smaller_sides = false;
    uint32_t samples = 66049;  // kMcgim: bound on width * height
    uint32_t charts = 0;      // kMcgim: how many are asked for, 0: chosen by the shape; more come out where topology or
                              // flattening needs them
    uint32_t node_side = 17;  // grid on which cut-nodes lie, so that all coarser levels down to it stay closed;
                              // made finer by the encoder where whole units of it do not suit the cut
    uint32_t bits = 12;       // quantizer: bits per coordinate of the bounding box, 8..20
    RateTarget rate;
    FitStrength fit = FitStrength::kAuto;
    bool density = true;  // more samples where a first sampling leaves more error; false: spread evenly

    // Attribute planes: sides are 2^j + 1, up to 4097, and independent of `side`; four times the bytes per doubling.
    uint32_t normal_side = 0;  // normals of the input; 0: none
    std::optional<uint32_t>
        color_side;  // colours of the input; 0: none; unset: none without colours, else about as fine
                     // as they are, up to 1025
    std::optional<double>
        plane_quality;  // 0..100, 10 more halve the step; unset: that of `rate` where it is a quality, 90
                        // for lossless images (planes are always lossy), else 75

    uint64_t seed = 1;
    uint32_t threads = 0;  // 0: all cores; the bytes do not depend on it
};

// One level of the file: all images, each at this level or at the coarsest that its seams can close.
struct LevelReport {
    uint32_t level = 0;                    // 0: full resolution
    uint32_t width = 0, height = 0;        // of the largest image
    uint64_t vertices = 0, triangles = 0;  // of the decoded surface
    uint64_t prefix_bytes = 0;             // of the file, that this level needs
    double psnr = 0;                       // dB, decoded surface against the input mesh
};

struct StageTime {
    std::string stage;
    double seconds = 0;
};

// What became of an attribute plane.
struct PlaneReport {
    enum class Kind { kNormals, kColors };
    Kind kind = Kind::kNormals;
    uint32_t width = 0, height = 0;  // of the largest image
    uint64_t bytes = 0;              // of its chunk
    // Decoded plane on the decoded surface against the input, over the input's surface.
    double mean_angle = 0;  // kNormals: degrees
    double psnr = 0;        // kColors: dB of the sRGB values
};

// Figures of one run, in the order they become known.
struct EncodeReport {
    uint64_t input_vertices = 0, input_triangles = 0;     // as read
    uint64_t welded_vertices = 0, removed_triangles = 0;  // by cleaning
    TopologySummary topology;                             // of the cleaned mesh
    Layout layout = Layout::kGim;                         // that was used
    uint32_t images = 0;                                  // kGim: one per component; else 1
    uint32_t width = 0, height = 0;                       // of the largest image
    uint64_t samples = 0;                                 // of all images
    uint32_t side = 0, node_side = 0;                     // kGim: side of the largest
    uint32_t cut_paths = 0;                               // of all images
    uint32_t charts = 0;                                  // kMcgim
    uint64_t defined_samples = 0;                         // kMcgim
    double packing_efficiency = 0;                        // kMcgim: defined_samples / samples
    double cut_length = 0;                                // object units
    double stretch_efficiency = 0;                    // 1 / (normalised L2 stretch)^2, 0..1, 1 = uniform and isotropic
    uint64_t folds = 0, folds_before_fit = 0;         // image faces that look away from the input's surface
    uint64_t flipped_triangles = 0;                   // in the parametrization; always 0 in a successful run
    double bits_per_sample = 0, bits_per_vertex = 0;  // file bits over samples / input vertices
    uint64_t file_bytes = 0, sideband_bytes = 0;
    std::vector<PlaneReport> planes;
    Comparison error;                 // decoded level 0 against the input mesh
    std::vector<LevelReport> levels;  // finest first
    std::vector<StageTime> times;
    double seconds = 0;
};

struct Encoded {
    std::vector<uint8_t> bytes;  // a complete .gim file
    EncodeReport report;
};

// A state on the way, for pictures: a mesh opened along its cut, and where its vertices lie in the plane.
struct Snapshot {
    std::string name;                          // for files: lower case, digits and hyphens
    std::string caption;                       // for people: what was done, and its figures
    TriangleMesh mesh;                         // vertices on the cut once per side of it
    std::vector<std::array<uint32_t, 2>> cut;  // edges of `mesh` along the cut and the input's boundaries
    std::vector<std::array<double, 2>> uv;     // per vertex; unit disk for the cut search, unit square afterwards
};
// Called with each state while encode() runs; making them costs about a tenth of the run. Never called concurrently.
using Observer = std::function<void(const Snapshot& state)>;

// Mesh to .gim. The mesh must clean up to an orientable 2-manifold; each connected component becomes one image (kGim).
Result<Encoded> encode(const TriangleMesh& mesh, const EncodeOptions& options, const Progress& progress = {},
                       const Observer& observer = {});

// An existing geometry image to .gim: side*side*3 floats, planar (all x, all y, all z), sample (i, j) at j*side + i.
// Boundary samples within `weld_tolerance` of each other (object units) are glued where that gives a closed surface.
Result<Encoded> encode_image(const std::vector<float>& planes, uint32_t side, double weld_tolerance,
                             const EncodeOptions& options, const Progress& progress = {});

}  // namespace gim
