#include "map/atlas.h"

void ale_atlas_init(ale_atlas_t *atlas)
{
    *atlas = (ale_atlas_t){.used = {true}, .next_id = 1};
}

/* A free place, or that of the oldest map but the first and the robot's. */
static uint8_t place_of_new(const ale_atlas_t *atlas)
{
    uint8_t place = ALE_FIRST_MAP;
    for (int k = ALE_FIRST_MAP + 1; k < ALE_ATLAS_MAPS; k++) {
        if (!atlas->used[k]) {
            return (uint8_t)k;
        }
        const bool older = place == ALE_FIRST_MAP || atlas->id[k] < atlas->id[place];
        place = k != atlas->current && older ? (uint8_t)k : place;
    }
    return place;
}

uint8_t ale_atlas_begin(ale_atlas_t *atlas)
{
    const uint8_t place = place_of_new(atlas);
    atlas->id[place] = atlas->next_id++;
    atlas->used[place] = true;
    atlas->current = place;
    return place;
}

void ale_atlas_absorb(ale_atlas_t *atlas, uint8_t from, uint8_t into)
{
    atlas->used[from] = false;
    atlas->current = atlas->current == from ? into : atlas->current;
}

void ale_atlas_join(ale_atlas_t *atlas, uint8_t into, ale_pose_t shift)
{
    atlas->join = (ale_map_join_t){.number = atlas->join.number + 1,
                                   .map_id = atlas->id[atlas->current],
                                   .into_map_id = atlas->id[into],
                                   .shift = shift};
    ale_atlas_absorb(atlas, atlas->current, into);
}

uint32_t ale_atlas_map_id(const ale_atlas_t *atlas)
{
    return atlas->id[atlas->current];
}

int32_t ale_atlas_find(const ale_atlas_t *atlas, uint32_t map_id)
{
    for (int32_t k = 0; k < ALE_ATLAS_MAPS; k++) {
        if (atlas->used[k] && atlas->id[k] == map_id) {
            return k;
        }
    }
    return ALE_NO_MAP;
}

uint32_t ale_atlas_maps(const ale_atlas_t *atlas)
{
    uint32_t count = 0;
    for (int k = 0; k < ALE_ATLAS_MAPS; k++) {
        count += atlas->used[k];
    }
    return count;
}
