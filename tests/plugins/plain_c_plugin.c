// SPDX-License-Identifier: Apache-2.0
/*
 * A plug-in in plain C99, which proves that the border needs nothing else: a tracer that asks the
 * host about every triangle. Instead of intersecting it answers what tests ask for: a ray from the
 * origin of instance i sees that instance's first triangle, where the host says that it is solid.
 */
#include "hone_plugin.h"

#include <stdlib.h>
#include <string.h>

struct hone_tracer {
    const hone_host* host;
    const hone_scene* scene;
};

static hone_status create(const hone_host* host, hone_tracer** tracer, hone_error* error) {
    *tracer = malloc(sizeof **tracer);
    if (*tracer == NULL) {
        strcpy(error->text, "no memory for a tracer");
        return HONE_OUT_OF_MEMORY;
    }
    (*tracer)->host = host;
    (*tracer)->scene = NULL;
    host->log(host, HONE_LOG_DEBUG, "made a tracer");
    return HONE_OK;
}

static void destroy(hone_tracer* tracer) {
    free(tracer);
}

static hone_status build(hone_tracer* tracer, const hone_scene* scene, hone_build_stats* stats,
                         hone_error* error) {
    size_t i;
    (void)error;
    tracer->scene = scene;
    stats->triangles = 0;
    for (i = 0; i < scene->instance_count; ++i)
        stats->triangles += scene->meshes[scene->instances[i].mesh].triangle_count;
    stats->bytes = sizeof *tracer;
    return HONE_OK;
}

/* The instance whose first triangle's first corner the ray starts from. */
static hone_hit answer(const hone_tracer* tracer, const hone_ray* ray) {
    const hone_scene* scene = tracer->scene;
    hone_hit hit = {HONE_NONE, HONE_NONE};
    uint32_t i;
    for (i = 0; i < scene->instance_count; ++i) {
        const hone_mesh* mesh = &scene->meshes[scene->instances[i].mesh];
        float corner[3];
        tracer->host->world_position(scene, i, scene->triangles[mesh->first_triangle][0], corner);
        hit.instance = i;
        hit.primitive = 0;
        if (memcmp(corner, ray->origin, sizeof corner) == 0 &&
            tracer->host->is_solid(scene, ray, hit) != 0)
            return hit;
    }
    hit.instance = HONE_NONE;
    hit.primitive = HONE_NONE;
    return hit;
}

struct query {
    const hone_tracer* tracer;
    const hone_ray* rays;
    hone_hit* hits;
    uint32_t* occluded;
};

static void answer_range(void* context, size_t begin, size_t end) {
    const struct query* query = context;
    size_t i;
    for (i = begin; i < end; ++i) {
        const hone_hit hit = answer(query->tracer, &query->rays[i]);
        if (query->hits != NULL)
            query->hits[i] = hit;
        else
            query->occluded[i] = hit.instance != HONE_NONE;
    }
}

static hone_status closest(hone_tracer* tracer, const hone_ray* rays, hone_hit* hits, size_t count,
                           uint32_t flags, hone_error* error) {
    struct query query = {tracer, rays, hits, NULL};
    (void)flags;
    (void)error;
    tracer->host->parallel_for(tracer->host, count, 16, answer_range, &query);
    return HONE_OK;
}

static hone_status occluded(hone_tracer* tracer, const hone_ray* rays, uint32_t* answers,
                            size_t count, uint32_t flags, hone_error* error) {
    struct query query = {tracer, rays, NULL, answers};
    (void)flags;
    (void)error;
    tracer->host->parallel_for(tracer->host, count, 16, answer_range, &query);
    return HONE_OK;
}

static const hone_trace_backend backend = {
    sizeof(hone_trace_backend),
    HONE_TRACE_ALWAYS_EXACT | HONE_TRACE_REFERENCE,
    "plain_c",
    "Sees the triangle whose first corner a ray starts from.",
    NULL,
    NULL,
    create,
    destroy,
    build,
    NULL,
    closest,
    occluded};

static const hone_trace_backend* const backends[] = {&backend};

static const hone_plugin plugin = {HONE_PLUGIN_MAGIC,
                                   sizeof(hone_plugin),
                                   HONE_PLUGIN_ABI_MAJOR,
                                   HONE_PLUGIN_ABI_MINOR,
                                   HONE_PLUGIN_BUILD,
                                   "plain_c",
                                   "2.1",
                                   "Apache-2.0",
                                   "A plug-in in plain C.",
                                   backends,
                                   1,
                                   NULL,
                                   0,
                                   NULL,
                                   0};

const hone_plugin* hone_plugin_entry(uint32_t abi_major, uint32_t abi_minor) {
    (void)abi_minor;
    return abi_major == HONE_PLUGIN_ABI_MAJOR ? &plugin : NULL;
}
