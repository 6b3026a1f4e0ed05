// SPDX-License-Identifier: Apache-2.0
/*
 * Passes of a plug-in: what hone_plugin::passes and hone_plugin::port_types point to. Part of the
 * border since its version 1.1; the rules of hone_plugin.h hold here, too. In C++, hone_pass.hpp on
 * top of it is shorter.
 *
 * Such a pass runs on the host. hone gives it the bytes of its inputs and outputs where they lie:
 * nothing is copied. A pass for a GPU is written in GLSL (pass type "glsl").
 */
#ifndef HONE_PASS_H
#define HONE_PASS_H

/* Not rooted: plug-ins have these headers alone. */
#include "hone_plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- What flows between passes --------------------------------------------------------------- */

#define HONE_SHAPE_PLANE 0u  /* an element a pixel: rows, the top one first; y * width + x */
#define HONE_SHAPE_LIST 1u   /* up to a capacity of elements, of which some are valid */
#define HONE_SHAPE_RECORD 2u /* a number of elements that the pass which makes it decides */

/* Which of the members min and max count; without, they are not looked at. */
#define HONE_HAS_MIN 1u
#define HONE_HAS_MAX 2u

/*
 * A type of ports that hone does not know. Ports are connected where their types have one name: it
 * says what the numbers mean, not how they lie. Two plug-ins may have a type of one name if shape,
 * stride and format are the same. hone's own types need no table: `hone passes NAME` shows those of
 * a pass's ports.
 */
typedef struct hone_port_type {
    uint32_t struct_size;
    uint32_t shape;     /* HONE_SHAPE_... */
    const char* name;   /* A-Z first, then letters and digits, at most 64 bytes: "Curvature" */
    const char* doc;    /* meaning, space, order */
    const char* format; /* an element in GLSL's words: "vec3"; NULL = another */
    const char* unit;   /* of its numbers: "m"; NULL = none, or told in doc */
    uint32_t stride;    /* bytes an element: a multiple of 4, at most 1024 */
    uint32_t flags;     /* HONE_HAS_... */
    /*
     * Where every number of an element lies, inclusive, for formats of float. A type that has one
     * of them has finite numbers only; hone refuses what a plug-in's pass writes outside, also to
     * ports of hone's own types.
     */
    double min;
    double max;
} hone_port_type;

/* As hone's rasteriser and tracer have it: right-handed, y up in the image plane. */
typedef struct hone_camera {
    float position[3];
    float forward[3]; /* unit, as the next two */
    float right[3];
    float up[3];
    float tan_half_fov_y;
    float near;        /* metres; nothing nearer is seen */
    float lens_radius; /* metres; 0 = a pinhole */
    float focus;       /* view depth in metres that a lens images sharply */
} hone_camera;

/* A parameter's value. */
typedef union hone_word {
    uint32_t u; /* bool: 0 or 1; uint; enum: the number of the choice */
    float f;    /* float */
} hone_word;

/* ---- What a pass type declares --------------------------------------------------------------- */

#define HONE_PARAM_BOOL 0u
#define HONE_PARAM_UINT 1u
#define HONE_PARAM_FLOAT 2u
#define HONE_PARAM_ENUM 3u

/* Names of ports and parameters: a-z, 0-9 and "_", a letter first, at most 64 bytes. */
typedef struct hone_param {
    uint32_t struct_size;
    uint32_t type; /* HONE_PARAM_... */
    const char* name;
    const char* doc;  /* what it does; special values ("0 = no limit") */
    const char* unit; /* "m", "px", "ms"; NULL = none, or told in doc */
    double fallback;  /* the default; enum: the number of the choice */
    double min;       /* of uint and float, inclusive */
    double max;
    uint32_t flags; /* HONE_HAS_... */
    uint32_t choice_count;
    const char* const* choices; /* enum: letters, digits, "_", "." and "-" */
} hone_param;

#define HONE_PORT_OPTIONAL 1u /* inputs: may be left unconnected */
#define HONE_PORT_VARIADIC 2u /* inputs: takes several edges, each with parameters of its own */

/* What a size is asked of; valid during the call. */
typedef struct hone_size_query {
    uint32_t struct_size;
    uint32_t output; /* number in hone_pass_type::outputs */
    uint32_t width;  /* of the frame */
    uint32_t height;
    const hone_word* params;  /* in the order of hone_pass_type::params */
    const size_t* capacities; /* elements by input port, all its edges'; 0 = none, not fed */
    size_t param_count;
    size_t input_count;
} hone_size_query;

typedef struct hone_port {
    uint32_t struct_size;
    uint32_t flags; /* HONE_PORT_... */
    const char* name;
    const char* type; /* a type of hone or of this plug-in: "Radiance" */
    const char* doc;
    /* Bytes that the pass takes an element for; hone refuses it where the type has another size.
       0 = the port has no elements (Scene, Camera, Extent). */
    uint32_t stride;
    uint32_t param_count; /* of each edge of a variadic input */
    const hone_param* const* params;
    /* Outputs: the input whose memory this output takes over. execute() finds the input's content
       there and updates it; zeros, where an optional input is not connected. NULL = none. */
    const char* in_place_of;
    /* Outputs: how many elements there must be room for; a function of what it is asked of, and of
       nothing else. NULL = an element a pixel of a plane, one of a record; a list needs it, unless
       it is in place of an input that is not optional. */
    size_t (*size)(const hone_size_query* query);
} hone_port;

/* ---- What a running pass sees: valid during execute() ---------------------------------------- */

/* What came over one edge. */
typedef struct hone_input {
    uint32_t struct_size;
    uint32_t port;    /* number in hone_pass_type::inputs */
    const void* data; /* elements; NULL where there are none */
    size_t count;     /* valid ones */
    uint32_t width;   /* of planes and of Extent */
    uint32_t height;
    const hone_scene* scene;   /* of Scene, else NULL */
    const hone_camera* camera; /* of Camera, else NULL */
    const hone_word* params;   /* the edge's, in the order of hone_port::params */
    uint64_t version; /* changes whenever the content does: what a pass may keep is of it */
} hone_input;

typedef struct hone_output {
    uint32_t struct_size;
    uint32_t width; /* of planes */
    uint32_t height;
    uint32_t reserved;
    void* data;      /* not cleared, unless in place of an input */
    size_t count;    /* valid elements: to be set for a list (0, or the input's in place of one) */
    size_t capacity; /* elements that there is room for */
} hone_output;

typedef struct hone_run {
    uint32_t struct_size;
    uint32_t iteration; /* inside a loop, from 1; outside 0 */
    void* hone;         /* hone's own */
    const char* node;   /* what the graph calls this pass */
    uint32_t width;     /* of the frame */
    uint32_t height;
    uint64_t seed; /* of all that is random: the same seed, the same output */

    /* By port, then by edge. A port that nothing feeds has one entry, whose data, scene, camera and
       width are 0: without variadic ports, inputs[i] is port i. */
    const hone_input* const* inputs;
    size_t input_count;
    hone_output* const* outputs; /* by port */
    size_t output_count;
    const hone_word* params; /* in the order of hone_pass_type::params */
    size_t param_count;

    /*
     * 1 once whoever waits wants control back (Ctrl-C, a time limit): execute() may then return
     * HONE_INTERRUPTED within 250 ms, and should where it takes longer. From any thread.
     */
    int32_t (*is_due)(const struct hone_run* run);
    /* 1: execute() gave up last time and nothing that it sees changed; outputs are what it left.
       Each call must get a little further, so that many short ones come to the end of one long one.
     */
    uint32_t goes_on;
    uint32_t reserved;

    /* Adds to a counter of hone_pass_type::counters. From the thread of execute() only. */
    void (*count)(const struct hone_run* run, uint32_t counter, uint64_t amount);
} hone_run;

/* ---- A pass type ----------------------------------------------------------------------------- */

/* Made by create(), one for each node of a graph; what it points to is the plug-in's own. */
typedef struct hone_pass hone_pass;

/*
 * A kind of pass. Its outputs may depend on inputs, parameters, size of the frame and seed only:
 * hone runs it again when one of them changed, and does not otherwise.
 *
 * hone calls the functions of one pass one at a time, from any thread. Different ones may be called
 * at once.
 */
typedef struct hone_pass_type {
    uint32_t struct_size;
    uint32_t flags; /* 0 */
    /* What graphs call it: a-z, 0-9, "_" and ".", a letter first, at most 64 bytes; no name of
       another pass type, not "auto" or "glsl". */
    const char* name;
    const char* doc; /* one sentence */

    const hone_port* const* inputs;
    size_t input_count;
    const hone_port* const* outputs; /* at least one */
    size_t output_count;
    const hone_param* const* params;
    size_t param_count;
    /* Names of what it counts. hone knows "rays.KIND" (all count for limits of rays) and "pixels"
       (requested). */
    const char* const* counters;
    size_t counter_count;

    /* Both NULL: the pass keeps nothing, and execute() gets NULL. */
    hone_status (*create)(const hone_host* host, hone_pass** pass, hone_error* error);
    void (*destroy)(hone_pass* pass);
    /* Does the work: writes every output. */
    hone_status (*execute)(hone_pass* pass, const hone_host* host, const hone_run* run,
                           hone_error* error);
} hone_pass_type;

#ifdef __cplusplus
}
#endif
#endif
