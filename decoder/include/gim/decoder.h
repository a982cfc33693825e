/* gim/decoder.h: reads .gim files (spec/gim-format.md). C99 and C++; gim/decoder.hpp adds memory management for C++20.
 *
 * Nothing here allocates, prints, throws or keeps state. Functions tell sizes; the caller brings the memory. A call
 * uses 32 KiB of stack at most. Every byte of the input is treated as hostile. Any number of threads may decode the
 * same bytes at the same time.
 *
 *   gim_info info;
 *   gim_status s = gim_read_info(bytes, size, NULL, &info);              // header and index only
 *   gim_level_info level;
 *   s = gim_read_level_info(&info, bytes, size, 0, 0, &level);           // image 0, level 0 = full resolution
 *   float*    positions = malloc(level.vertex_count * 3 * sizeof(float));
 *   uint32_t* triangles = malloc(level.triangle_count * 3 * sizeof(uint32_t));
 *   void*     scratch   = malloc(level.scratch_size);
 *   s = gim_decode_mesh(&info, bytes, size, 0, 0, positions, NULL, NULL, triangles, scratch, level.scratch_size);
 *
 * A file holds images: grids of surface points with width x height samples. The layout of the file says how the surface
 * lies in them.
 *   GIM_LAYOUT_GIM    One image per connected component. Each is a square of side x side samples, all of them on the
 *                     surface; side = 2^j + 1, and level L has side 2^(j-L) + 1. Images of one file may differ in side.
 *                     A level of the file leaves out the images that are too small for it.
 *   GIM_LAYOUT_MCGIM  One image. Charts are packed into its rectangle; samples outside them are undefined. Level L
 *                     keeps every 2^L-th row and column of each chart. Or it is the image of another program
 *                     (gim_read_raster_info): then there is level 0 only.
 *   GIM_LAYOUT_TILES  One image. Square tiles of side x side samples, side = 2^k + 1, are glued along their sides. In the
 *                     image they lie in slots of a rectangle, tile after tile; samples of slots without a tile are
 *                     undefined. Level L has tiles of side 2^(k-L) + 1.
 * Seams are where the surface was cut open to lie in the plane. Decoding closes them: the mesh is watertight where the
 * surface is.
 * Seen from outside the surface, rows and columns turn the same way in every layout:
 * (d position / d column) x (d position / d row) points outwards. */
#ifndef GIM_DECODER_H
#define GIM_DECODER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef GIM_API
#define GIM_API
#endif

/* Negative: give more bytes and call again. Zero: done. Positive: final. Numbers are never reused. */
typedef int32_t gim_status;
enum {
    GIM_NEED_MORE_INPUT = -1,
    GIM_OK = 0,
    GIM_NOT_GIM = 1,
    GIM_UNSUPPORTED_VERSION = 2,
    GIM_MALFORMED = 3,
    GIM_LIMIT_EXCEEDED = 4,
    GIM_BAD_ARGUMENT = 5,
    GIM_SCRATCH_TOO_SMALL = 6,
    GIM_CHECKSUM = 7,
    GIM_NO_SUCH_LEVEL = 8,
    GIM_NO_SUCH_PLANE = 9
};
/* A short English description of any status; never NULL. */
GIM_API const char* gim_status_text(gim_status status);

enum { GIM_LAYOUT_GIM = 0, GIM_LAYOUT_MCGIM = 1, GIM_LAYOUT_TILES = 2 };
enum { GIM_CODING_LOSSLESS = 0, GIM_CODING_LOSSY = 1 };
enum { GIM_MAX_LEVELS = 14 };

/* The largest file that the caller accepts. NULL in place of a gim_limits* means the defaults. */
typedef struct gim_limits {
    uint64_t max_samples; /* samples of all images together; default 2^26 */
    uint32_t max_images;  /* default 65536 */
    uint32_t max_side;    /* samples along a row or column; default 16385 */
} gim_limits;

/* A box along the axes, in the coordinates of decoded positions (relative to gim_info.origin if is_relative). */
typedef struct gim_box {
    float low[3], high[3];
} gim_box;

/* Header and index of a file. It holds plain values and no pointer into the bytes. */
typedef struct gim_info {
    uint32_t version;
    uint32_t layout;       /* GIM_LAYOUT_... */
    uint32_t coding;       /* GIM_CODING_... */
    uint32_t bits;         /* quantizer: bits per coordinate of the bounding box, 8..20 */
    uint32_t image_count;  /* GIM_LAYOUT_GIM: any; else 1 */
    uint32_t level_count;  /* levels in the file; an image has levels 0 .. gim_level_info.coarsest_level */
    uint32_t chunk_count;  /* for gim_read_chunk */
    uint64_t sample_count; /* of all images at level 0, undefined ones included. GIM_LAYOUT_MCGIM: as before a cut */
    uint64_t file_size;    /* of the whole file, as the index says */
    double origin[3];      /* where coordinates of 0 units lie, in object units; of all images */
    uint32_t
        is_relative;     /* 1: decoded positions are relative to origin, because floats could not hold their sum: add it
                              in doubles. 0: decoded positions contain it. Normals are the same either way */
    float step;          /* object units per quantization step, > 0. Lossless: positions are whole steps from origin */
    float quantizer;     /* lossy: step across the surface, in quantization steps, at unit norm and mean density.
                              lossless: 0 */
    uint32_t index_size; /* bytes of header and index; a prefix of this length suffices for gim_read_info */
    /* Level 0 first: distances between the surface of a level and the encoder's input, the larger of both ways, in object
     * units, as the encoder measured them, rounded up by 7 % at most. 0: the file does not say */
    float level_rms_error[GIM_MAX_LEVELS];
    float level_max_error[GIM_MAX_LEVELS];
    uint32_t has_boxes; /* 1: the file tells the boxes of all its images. 0: boxes are without end */
    gim_box box;        /* holds the boxes of all images (gim_read_box) */
    gim_limits limits;  /* later calls obey them */
} gim_info;

/* Reads header and index and verifies their checksum. Cost O(index). */
GIM_API gim_status gim_read_info(const void* bytes, size_t size, const gim_limits* limits, gim_info* info);

/* Tells a box that holds an image at each of its levels, with its displacements. It reaches less than 1/256 of the
 * surface's largest extent beyond them on each side. -FLT_MAX .. FLT_MAX, which nothing culls, if the file does not tell
 * one. Needs header and index only. Cost O(index). */
GIM_API gim_status gim_read_box(const gim_info* info, const void* bytes, size_t size, uint32_t image, gim_box* box);

/* How a camera sees a surface. */
typedef struct gim_view {
    float distance;        /* from the eye to the nearest point of the surface, or of its box; object units */
    float vertical_fov;    /* radians; that of the viewport's height */
    float viewport_height; /* pixels */
    float pixel_error;     /* how large level_max_error may be on the screen, pixels */
} gim_view;

enum { GIM_NO_LEVEL = 0x7FFFFFFF };

/* Returns the level to show: the coarsest one whose maximum error is at most pixel_error on the screen; 0 if there is
 * none, if the eye is inside (distance <= 0), or if a value is no number.
 * shown  the level shown before, GIM_NO_LEVEL if there is none. A coarser one replaces it only if its error is at most
 *        3/4 of pixel_error, so a surface near the limit does not change back and forth. A finer one comes at once
 * The level is the file's: take that of an image, and not beyond gim_level_info.coarsest_level. Levels whose error the
 * file does not tell are not chosen, except level 0. Cost O(levels). */
GIM_API uint32_t gim_choose_level(const gim_info* info, const gim_view* view, uint32_t shown);

/* One level of one image. */
typedef struct gim_level_info {
    uint32_t side;           /* GIM_LAYOUT_GIM: samples per side, equal to width and height. Else 0 */
    uint32_t width, height;  /* samples of the grid */
    uint32_t coarsest_level; /* the coarsest level at which this image can be decoded */
    uint32_t vertex_count;   /* of the mesh, where samples of one surface point share a vertex */
    uint32_t triangle_count; /* of mesh and grid alike */
    uint64_t prefix_size;    /* bytes of the file, from its start, that this level needs */
    uint64_t scratch_size;   /* bytes of scratch that the decode calls need on this level */
    float rms_error;         /* gim_info.level_rms_error of this level */
    float max_error;         /* gim_info.level_max_error of this level */
    gim_box box;             /* of the image, as gim_read_box tells it */
} gim_level_info;

/* level: 0 = full resolution. Returns GIM_NO_SUCH_LEVEL beyond coarsest_level. Reads the chunk of seams (SEAM), so
 * `size` must reach beyond it. Cost: GIM_LAYOUT_GIM O(chunk + side), else O(chunk). */
GIM_API gim_status gim_read_level_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                       uint32_t level, gim_level_info* level_info);

/* Decodes one level of one image into its grid.
 * positions  width*height*3 floats, row by row, in object units; relative to gim_info.origin if is_relative. Samples of
 *            one surface point are bit-equal; the correction that made them so fades out into the interior. Undefined
 *            samples (not GIM_LAYOUT_GIM) are NaN
 * scratch    scratch_size bytes, aligned to 16 bytes; their contents are undefined afterwards
 * GIM_LAYOUT_MCGIM: at level 0 the grid is the rectangle that the charts are packed into. At other levels the charts
 * lie beside each other in a grid of its own. GIM_LAYOUT_TILES: samples on the side of a tile are repeated in each tile.
 * Reads only the first prefix_size bytes. On failure positions are unspecified. Cost O(samples). The floats are the
 * same bits on every platform. */
GIM_API gim_status gim_decode_positions(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                        uint32_t level, float* positions, void* scratch, size_t scratch_size);

/* Decodes the same level into an indexed triangle mesh without gaps at the seams. All outputs but positions may be
 * NULL.
 * positions  vertex_count*3 floats, in object units, relative as in gim_decode_positions. GIM_LAYOUT_GIM: first the
 *            vertices of the image's rim, then the inner samples row by row. GIM_LAYOUT_MCGIM: chart after chart, each
 *            row by row; a vertex comes where its first sample is. GIM_LAYOUT_TILES: corners of tiles, then the inner
 *            samples of their sides, then those of the tiles row by row
 * normals    vertex_count*3 floats of unit length; 0 0 0 where the surface has no normal
 * texcoords  vertex_count*2 floats: u = column / (width-1), v = row / (height-1) in the grid of level 0, at every
 *            level; if the file was cut, of the level 0 before that. A vertex on a seam has those of its first sample.
 *            GIM_LAYOUT_MCGIM: coarse levels may reach beyond 0..1
 * triangles  triangle_count*3 indices, counter-clockwise seen from outside. Quads are split along the shorter diagonal,
 *            except where that would give the mesh an edge twice (spec, "Surface", "Charts", "Tiles") */
GIM_API gim_status gim_decode_mesh(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                   float* positions, float* normals, float* texcoords, uint32_t* triangles,
                                   void* scratch, size_t scratch_size);

/* Decodes the same level into a mesh that shades as the surface is meant to: vertices on sharp edges are split, and each
 * of them has the normal of its side. GIM_LAYOUT_TILES, if the file says which edges are sharp; else gim_decode_mesh.
 * The first vertices are those of gim_decode_mesh. Copies of those on sharp edges follow, with equal positions and with
 * texcoords of their own. Triangles come in the same order.
 * vertex_count  receives the number of vertices. All outputs must have room for width*height vertices; there are no more
 * The rest is as in gim_decode_mesh. */
GIM_API gim_status gim_decode_hard_mesh(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                        uint32_t level, uint32_t* vertex_count, float* positions, float* normals,
                                        float* texcoords, uint32_t* triangles, void* scratch, size_t scratch_size);

/* Decodes the same level into a grid mesh, for texturing. Its vertices are the width*height samples, row by row;
 * samples of one surface point have equal positions and normals, and texcoords of their own. Undefined
 * samples are in no triangle; their positions are NaN, their normals and texcoords 0. triangles index samples.
 * Otherwise as gim_decode_mesh. */
GIM_API gim_status gim_decode_grid(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                   float* positions, float* normals, float* texcoords, uint32_t* triangles,
                                   void* scratch, size_t scratch_size);

/* Attribute planes hold what a surface has besides its shape. They are images on the same square or rectangle at a
 * resolution of their own: sample (row, column) of a plane belongs to the surface point at row/(height-1),
 * column/(width-1) of the image's level 0. A file has at most one plane of each kind for all its images.
 *   GIM_PLANE_NORMALS  the input's unit normals in object space, pointing out of the surface; 0 0 0 where undefined
 *   GIM_PLANE_COLORS   red, green, blue in 0..1, encoded as sRGB
 *   GIM_PLANE_DISPLACEMENTS  what is to be added to points of the surface at level 0, in object units (gim/refine.h,
 *                      "details"); 0 0 0 almost everywhere
 * GIM_LAYOUT_GIM, GIM_LAYOUT_TILES: samples of one surface point are bit-equal, on sharp edges too. GIM_LAYOUT_MCGIM,
 * GIM_LAYOUT_TILES: between charts and between tiles the values go on, so that a texture filter may read them. */
enum { GIM_PLANE_NORMALS = 0, GIM_PLANE_COLORS = 1, GIM_PLANE_DISPLACEMENTS = 2 };
typedef struct gim_plane_info {
    uint32_t width, height;  /* samples at this level of the plane */
    uint32_t coarsest_level; /* of the plane; level L keeps every 2^L-th row and column */
    float quantizer;         /* quantizer step as our encoder uses it: colours in 1/255, normals in 1/1024,
                              displacements in units of the file */
    uint64_t stream_size;    /* bytes of this image's plane in the file */
    uint64_t prefix_size;    /* bytes of the file, from its start, that the plane needs */
    uint64_t scratch_size;   /* bytes of scratch that gim_decode_plane needs on this level */
} gim_plane_info;

/* level: of the plane, 0 = full resolution. Returns GIM_NO_SUCH_PLANE if the file has none of that kind (the index says
 * so), and GIM_NEED_MORE_INPUT if fewer than prefix_size bytes are there. Cost O(chunk). */
GIM_API gim_status gim_read_plane_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                       uint32_t kind, uint32_t level, gim_plane_info* plane_info);

/* values: width*height*3 floats, row by row. scratch: as for positions. On failure values are unspecified. Cost
 * O(samples). The floats are the same bits on every platform. */
GIM_API gim_status gim_decode_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                                    uint32_t level, float* values, void* scratch, size_t scratch_size);

/* Labels say which part of a surface a cell belongs to, for example which material it has. A cell is two triangles: label
 * i is that of triangles 2i and 2i+1 of gim_decode_mesh, gim_decode_hard_mesh and gim_decode_grid. Borders between labels
 * are edges of the mesh, so parts fit together without cracks. GIM_LAYOUT_MCGIM has none. */
typedef struct gim_labels_info {
    uint32_t cell_count;   /* of this level: half its triangle_count */
    uint64_t scratch_size; /* bytes of scratch that gim_decode_labels needs */
    uint64_t prefix_size;  /* bytes of the file, from its start, that labels need: more than the level does */
} gim_labels_info;

/* level: as in gim_decode_mesh. Returns GIM_NO_SUCH_PLANE if the file has no labels: then all cells are alike. Reads the
 * index and the chunk of seams. Cost as gim_read_level_info. */
GIM_API gim_status gim_read_labels_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                        uint32_t level, gim_labels_info* labels_info);

/* labels: cell_count bytes. A coarse cell has the label of the finest cell behind its middle. scratch: scratch_size bytes of
 * any alignment. Needs the level's seams and the labels, but no positions. On failure labels are unspecified. Cost O(cells
 * of level 0, before the file was cut). */
GIM_API gim_status gim_decode_labels(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                     uint32_t level, uint8_t* labels, void* scratch, size_t scratch_size);

/* An imported image: the array of another program, as numbers of each channel. A file of layout GIM_LAYOUT_MCGIM may hold
 * one instead of charts. It has one level. gim_decode_mesh and gim_decode_grid give its surface. */
enum {
    GIM_SAMPLE_FLOAT32 = 0,
    GIM_SAMPLE_FLOAT64 = 1,
    GIM_SAMPLE_FLOAT16 = 2,
    GIM_SAMPLE_UINT8 = 3,
    GIM_SAMPLE_INT8 = 4,
    GIM_SAMPLE_UINT16 = 5,
    GIM_SAMPLE_INT16 = 6,
    GIM_SAMPLE_UINT32 = 7,
    GIM_SAMPLE_INT32 = 8
};
enum { GIM_MASK_NONE = 0, GIM_MASK_ARRAY = 1, GIM_MASK_CHANNEL = 2 };
typedef struct gim_raster_info {
    uint32_t width, height;     /* samples */
    uint32_t channels;          /* numbers of a sample, at least 3: x, y, z, then others. The mask is none of them */
    uint32_t sample_type;       /* of the array that was imported: GIM_SAMPLE_... */
    uint32_t is_channels_first; /* 1: that array had the shape channels, height, width. 0: height, width, channels */
    uint32_t mask;              /* where its mask was. GIM_MASK_NONE: undefined samples were NaN, or there were none;
                                   GIM_MASK_ARRAY: in another array; GIM_MASK_CHANNEL + k: in channel k of the array */
    uint32_t mask_value;        /* what that said of defined samples; 0 of others */
    uint64_t prefix_size;       /* bytes of the file, from its start, that the samples need */
    uint64_t scratch_size;      /* bytes of scratch that gim_decode_raster needs */
} gim_raster_info;

/* Returns GIM_NO_SUCH_PLANE if the file holds no imported image. Cost O(chunk). */
GIM_API gim_status gim_read_raster_info(const gim_info* info, const void* bytes, size_t size, gim_raster_info* raster);

/* A number v of the channel stands for origin + step * v. */
typedef struct gim_raster_channel {
    uint32_t bits;       /* numbers are 0 .. 2^bits - 1 */
    double origin, step; /* step > 0. Of whole numbers that are exact: the least one, and 1 */
} gim_raster_channel;

/* Returns GIM_BAD_ARGUMENT beyond the last channel. Cost O(chunk). */
GIM_API gim_status gim_read_raster_channel(const gim_info* info, const void* bytes, size_t size, uint32_t channel,
                                           gim_raster_channel* out);

/* Decodes all channels.
 * values   width*height*channels numbers, sample by sample, row by row; 0 of undefined samples
 * mask     width*height bytes: 1 if the sample is defined, else 0
 * scratch  as for positions. On failure values and mask are unspecified. Cost O(samples * channels) */
GIM_API gim_status gim_decode_raster(const gim_info* info, const void* bytes, size_t size, int32_t* values,
                                     uint8_t* mask, void* scratch, size_t scratch_size);

/* Describes chunk i of the index, for tools. Returns GIM_BAD_ARGUMENT past the last chunk. */
typedef struct gim_chunk {
    char name[8];  /* zero-terminated, as in the spec; "????" if this reader does not know it */
    uint32_t type; /* its number in the file */
    int32_t level; /* -1 if it is not a level */
    uint64_t offset, size;
    uint64_t raw_size; /* after decompression; equal to size if the chunk is not compressed */
    uint32_t intact;   /* 1 if the bytes are there and their checksum is right, else 0 */
} gim_chunk;
GIM_API gim_status gim_read_chunk(const gim_info* info, const void* bytes, size_t size, uint32_t i, gim_chunk* chunk);

/* Reads the text that the file carries about itself (META chunk): UTF-8, not zero-terminated.
 * text_size  receives its length in bytes, 0 if there is none. The length is a claim of the file: cap it before you
 *            allocate
 * text       receives the text; if it is longer than capacity, GIM_SCRATCH_TOO_SMALL. NULL to ask for the length only
 * scratch    gim_text_scratch_size() bytes, aligned to 16 bytes; may be NULL if text is */
GIM_API size_t gim_text_scratch_size(void);
GIM_API gim_status gim_read_text(const gim_info* info, const void* bytes, size_t size, char* text, size_t capacity,
                                 uint64_t* text_size, void* scratch, size_t scratch_size);

/* Reads the seams of an image at a level, for tools.
 * class_of    GIM_LAYOUT_GIM: 4*(side-1) entries, one per sample of the rim, along row 0, down the last column, back
 *             along the last row and up column 0. Samples of one surface point have equal numbers. NULL if not wanted;
 *             it must be NULL in other layouts
 * path_count  receives how many paths the seams have: of the cut, of the charts' borders, or sides of tiles (two that are
 *             glued count once). NULL if not wanted */
GIM_API gim_status gim_read_seams(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                  uint32_t* class_of, uint32_t* path_count);

#ifdef __cplusplus
}
#endif

#endif
