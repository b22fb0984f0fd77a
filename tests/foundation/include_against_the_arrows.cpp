// As a file of libthin/estimation would see it: thinning lies above estimation.
#include "libthin/thinning/thinning_method.h"
