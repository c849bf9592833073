/* ale-merge: many drives, one map. */
#include "lab/merge/into.h"
#include "lab/merge/merge.h"

namespace
{

int obey(const merge::Options &options)
{
    if (options.versions) {
        return merge::list_versions(options.drives.front());
    }
    return options.into.empty() ? merge::merge(options) : merge::merge_into(options);
}

} // namespace

int main(int argc, char **argv)
{
    return merge::with_options(argc, argv, obey);
}
