// SPDX-License-Identifier: Apache-2.0
/*
 * The border between hone and its plug-ins: C99 and nothing else, so that a plug-in built by any
 * compiler works with a hone built by another. In C++, hone_plugin.hpp on top of it is shorter.
 *
 * A plug-in is a shared library that exports one function, hone_plugin_entry, which returns static
 * tables: what the plug-in is called and which trace backends and passes (hone_pass.h) it offers.
 * hone checks the tables and calls the functions in them.
 *
 * Rules for both sides
 * - Nothing throws across the border. Functions that can fail return a hone_status and write the
 *   reason to a hone_error.
 * - Every struct that may grow begins with struct_size, its sizeof where it was filled. Whoever
 *   reads it takes missing members for 0. A minor version of this border adds members at the end of
 *   such structs; a major version may change anything after hone_plugin::abi_minor.
 * - Texts are UTF-8 without control bytes, ended by 0. hone copies those of tables while it loads.
 * - Memory belongs to whoever made it. Nobody frees what the other side allocated.
 * - Lengths are metres, right-handed, y up.
 */
#ifndef HONE_PLUGIN_H
#define HONE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HONE_PLUGIN_MAGIC 0x454e4f48u /* "HONE" */
#define HONE_PLUGIN_ABI_MAJOR 1u
#define HONE_PLUGIN_ABI_MINOR 1u /* 1: passes */

/* "None": no texture, no hit. */
#define HONE_NONE 0xffffffffu

#if defined(_WIN32)
#define HONE_PLUGIN_EXPORT __declspec(dllexport)
#else
#define HONE_PLUGIN_EXPORT __attribute__((visibility("default")))
#endif

/* ---- What a call ends with ------------------------------------------------------------------ */

typedef int32_t hone_status;
#define HONE_OK 0
#define HONE_FAILED 1        /* anything without a number of its own */
#define HONE_NO_DEVICE 2     /* what the backend runs on is not here, or was lost */
#define HONE_OUT_OF_MEMORY 3 /* of the host or of a device */
#define HONE_INTERRUPTED 4   /* a pass gave up because it was asked to (hone_run::is_due) */

/* Why a call failed: written by the callee, only where it does not return HONE_OK. */
typedef struct hone_error {
    char text[512]; /* which thing, what is wrong, what to do; ended by 0 */
} hone_error;

/* ---- Records: the very bytes that hone works on ---------------------------------------------- */

/*
 * Seen are hits with tmin <= t <= tmax at origin + t * direction, world space, never behind the
 * origin (a negative tmin counts as 0). The direction need not be unit. A ray hits nothing if a
 * number of its origin or direction is not finite or reaches 1e18, if its direction is zero,
 * tmin > tmax, or either is NaN: a tracer must expect such rays.
 */
typedef struct hone_ray {
    float origin[3];
    float tmin;
    float direction[3];
    float tmax;
} hone_ray;

/* A triangle, counted inside its instance's mesh; both HONE_NONE for nothing. */
typedef struct hone_hit {
    uint32_t instance;
    uint32_t primitive;
} hone_hit;

/* Triangles with one material. hone_hit::primitive counts from first_triangle. */
typedef struct hone_mesh {
    uint32_t first_triangle;
    uint32_t triangle_count;
    uint32_t material;
    uint32_t first_cluster; /* clusters are the rasteriser's */
    uint32_t cluster_count;
} hone_mesh;

/* A mesh placed in the world. */
typedef struct hone_instance {
    float to_world[4][3]; /* object to world space: four columns, the last is the translation */
    float normal_matrix[3][3]; /* three columns: inverse transpose of the linear part */
    uint32_t mesh;
    uint32_t probe;   /* shading's */
    uint32_t flipped; /* 1: to_world mirrors, front faces turn clockwise */
} hone_instance;

#define HONE_MATERIAL_TWO_SIDED 1u /* both faces are seen */
#define HONE_MATERIAL_MASKED 2u    /* alpha below alpha_cutoff is a hole */
#define HONE_MATERIAL_MIRROR 4u    /* shading's */

typedef struct hone_material {
    float base_color[3];         /* shading's, as are emission and f0 */
    uint32_t base_color_texture; /* its alpha masks; or HONE_NONE */
    float emission[3];
    float alpha; /* [0,1], multiplies the texture's alpha */
    float f0[3];
    float alpha_cutoff;
    uint32_t flags; /* HONE_MATERIAL_... */
} hone_material;

/* Texels are RGBA8 words, red lowest: mip levels one after another, rows top down. */
typedef struct hone_texture {
    uint32_t first_texel;
    uint32_t width;
    uint32_t height;
    uint32_t levels;
    uint32_t wrap_u; /* 0 repeat, 1 clamp, 2 mirrored repeat */
    uint32_t wrap_v;
} hone_texture;

/*
 * A scene's arrays, where hone has them: not copies. Indices in them are in range.
 *
 * From a backend's build() to its next build() or destroy(), the scene and its arrays stay where
 * they are; instances change, and only before update(). A backend may keep the pointer; a pass has
 * it for one execute().
 */
typedef struct hone_scene {
    uint32_t struct_size;
    uint32_t reserved;
    const void* hone; /* hone's own: pass the scene to host functions as it came */

    const float (*positions)[3]; /* object space */
    const float (*normals)[3];   /* unit, as many as positions */
    const float (*uvs)[2];       /* as many as positions; (0,0) is a texture's top left */
    size_t position_count;
    const uint32_t (*triangles)[3]; /* numbers in positions */
    size_t triangle_count;
    const hone_mesh* meshes;
    size_t mesh_count;
    const hone_instance* instances;
    size_t instance_count;
    const hone_material* materials;
    size_t material_count;
    const hone_texture* textures;
    size_t texture_count;
    const uint32_t* texels;
    size_t texel_count;
} hone_scene;

/* ---- What hone does for a plug-in ------------------------------------------------------------ */

#define HONE_LOG_DEBUG 1
#define HONE_LOG_INFO 2 /* once per device or graph */
#define HONE_LOG_WARN 3 /* works, but worse: say what would cure it. Errors are statuses. */

/* Given to create(); valid until destroy() of what create() made has returned. */
typedef struct hone_host {
    uint32_t struct_size;
    uint32_t abi_major; /* of this hone */
    uint32_t abi_minor;
    uint32_t reserved;
    void* hone; /* hone's own */

    /* Says something to the person in front of hone. From any thread. */
    void (*log)(const struct hone_host* host, int32_t level, const char* text);

    /*
     * 1 if the point that `ray` sees on the triangle `hit` is solid, 0 if it is a hole of a mask:
     * hone's own alpha test, so that all backends have the same holes. 1 for materials that are not
     * masked. From any thread.
     */
    int32_t (*is_solid)(const hone_scene* scene, const hone_ray* ray, hone_hit hit);

    /*
     * Where `vertex` (a number in hone_scene::positions) of `instance` stands in world space, in
     * the arithmetic of hone's rasteriser and shading. From any thread.
     */
    void (*world_position)(const hone_scene* scene, uint32_t instance, uint32_t vertex,
                           float position[3]);

    /*
     * Calls body(context, begin, end) for ranges of at most `grain` (> 0) that cover [0, count)
     * once, on the threads that hone may use, in any order, and returns when all have. May be
     * called from a body. The body must not throw.
     */
    void (*parallel_for)(const struct hone_host* host, size_t count, size_t grain,
                         void (*body)(void* context, size_t begin, size_t end), void* context);
} hone_host;

/* ---- What a plug-in offers ------------------------------------------------------------------- */

/* What a backend promises; all optional. */
#define HONE_TRACE_ALWAYS_EXACT 1u /* HONE_QUERY_EXACT changes nothing */
#define HONE_TRACE_SETTLES_TIES 2u /* of equal t the least (instance, primitive) is answered */
#define HONE_TRACE_UPDATES 4u      /* update() is less work than build() */
#define HONE_TRACE_REFERENCE 8u    /* takes time linear in triangles: for tiny scenes */
#define HONE_TRACE_NO_MASKS 16u    /* takes masked surfaces for solid */

/* How a list of rays is asked. Hints never change an answer. */
#define HONE_QUERY_COHERENT 1u /* hint: neighbours in the list point alike */
#define HONE_QUERY_EXACT 2u    /* answer each ray as if it were alone, at the price of speed */

/* What a build made. A backend may leave it as hone filled it: 0 = not known. */
typedef struct hone_build_stats {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t triangles;    /* in the structure, after instancing; filled with the scene's */
    uint64_t bytes;        /* of the structure */
    uint64_t copied_bytes; /* of the scene's arrays that exist once more because of it */
} hone_build_stats;

/* Made by create(); what it points to is the plug-in's own. */
typedef struct hone_tracer hone_tracer;

/*
 * A trace backend: answers what rays see and whether they are blocked. It knows nothing of light.
 *
 * What must be answered:
 * - A closest hit is the one with the least t in [tmin, tmax]. Back faces of materials without
 *   HONE_MATERIAL_TWO_SIDED are not seen; a front face turns counter-clockwise seen from the ray's
 *   origin, clockwise where hone_instance::flipped. Of equal t either may be answered, unless the
 *   backend says HONE_TRACE_SETTLES_TIES.
 * - Occluded asks whether anything is in [tmin, tmax]; both faces block.
 * - Where is_solid() says 0 there is nothing.
 * - Triangles without area are never hit.
 *
 * hone calls the functions of one tracer one at a time, from any thread. Different tracers may be
 * called at once. All functions but update are required.
 */
typedef struct hone_trace_backend {
    uint32_t struct_size;
    uint32_t flags; /* HONE_TRACE_... */
    /* What graphs call it: a-z, 0-9, "_" and ".", a letter first, at most 64 bytes; not "auto", no
       name of another backend. A name within a plug-in is best prefixed with the plug-in's. */
    const char* name;
    const char* doc;     /* one sentence */
    const char* version; /* of what answers: "3.13.5"; NULL = the plug-in's */
    const char* runs_on; /* a device's name; NULL = "host" */

    /* Makes a tracer. What it runs on is missing: HONE_NO_DEVICE. */
    hone_status (*create)(const hone_host* host, hone_tracer** tracer, hone_error* error);
    void (*destroy)(hone_tracer* tracer);
    /* Takes a scene, possibly another than before. May have no instances. */
    hone_status (*build)(hone_tracer* tracer, const hone_scene* scene, hone_build_stats* stats,
                         hone_error* error);
    /* Follows instances that moved since: `moved` ascends. NULL = hone builds again. */
    hone_status (*update)(hone_tracer* tracer, const hone_scene* scene, const uint32_t* moved,
                          size_t moved_count, hone_build_stats* stats, hone_error* error);
    /* hits[i] answers rays[i]; count > 0; after a build that succeeded. flags: HONE_QUERY_... */
    hone_status (*closest)(hone_tracer* tracer, const hone_ray* rays, hone_hit* hits, size_t count,
                           uint32_t flags, hone_error* error);
    /* occluded[i] = 1 or 0 for rays[i]; as closest. */
    hone_status (*occluded)(hone_tracer* tracer, const hone_ray* rays, uint32_t* occluded,
                            size_t count, uint32_t flags, hone_error* error);
} hone_trace_backend;

/*
 * What hone_plugin_entry returns: static, never freed. The first four members are the handshake and
 * stay what they are in every version.
 */
typedef struct hone_plugin {
    uint32_t magic; /* HONE_PLUGIN_MAGIC */
    uint32_t struct_size;
    uint32_t abi_major; /* HONE_PLUGIN_ABI_MAJOR; hone refuses another */
    uint32_t abi_minor; /* HONE_PLUGIN_ABI_MINOR; older and newer ones work together */

    const char* build; /* how it was built, for reports: HONE_PLUGIN_BUILD says the compiler */
    const char* name;  /* as a backend's name; one plug-in of a name is loaded */
    const char* version;
    const char* license; /* SPDX expression */
    const char* doc;     /* one sentence */

    const hone_trace_backend* const* trace_backends;
    size_t trace_backend_count;

    const struct hone_pass_type* const* passes; /* hone_pass.h; NULL and 0 before 1.1 */
    size_t pass_count;

    /* Since 1.1: types of ports that hone does not know. */
    const struct hone_port_type* const* port_types;
    size_t port_type_count;
} hone_plugin;

/* The compiler, for hone_plugin::build. */
#if defined(__clang__)
#define HONE_PLUGIN_BUILD __VERSION__ /* "Clang 14.0.6" */
#elif defined(__GNUC__)
#define HONE_PLUGIN_BUILD "GCC " __VERSION__
#else
#define HONE_PLUGIN_BUILD "unknown compiler"
#endif

/*
 * The one function that a plug-in exports; called once, before anything else. It gets the version
 * of the border that hone speaks and returns the plug-in's tables, or NULL if it cannot work with
 * that hone.
 */
#define HONE_PLUGIN_ENTRY "hone_plugin_entry"
typedef const hone_plugin* (*hone_plugin_entry_function)(uint32_t abi_major, uint32_t abi_minor);
HONE_PLUGIN_EXPORT const hone_plugin* hone_plugin_entry(uint32_t abi_major, uint32_t abi_minor);

#ifdef __cplusplus
}
#endif
#endif
