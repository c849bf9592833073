/* ale-merge: many drives, one map. */
#include "lab/merge/merge.h"

int main(int argc, char **argv)
{
    return merge::with_options(argc, argv, merge::merge);
}
