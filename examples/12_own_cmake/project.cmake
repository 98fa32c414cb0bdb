# Every build of this project reads this file: `tessera simulate`, `run`, `test` and the studio.
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
target_link_libraries(project INTERFACE Eigen3::Eigen)
