# find_package(weft): defines the target weft::weft.
include(CMakeFindDependencyMacro)
find_dependency(TBB 2021.8)
include(${CMAKE_CURRENT_LIST_DIR}/weft-targets.cmake)
