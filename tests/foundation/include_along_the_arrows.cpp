// As a file of libthin/estimation would see it.
#include "libthin/estimation/gaussian_filter.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/observations/observation_set.h"
