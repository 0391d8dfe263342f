package skein.mujoco;

import java.nio.file.Path;

/** The library that {@link MujocoCalls} loads on its first call; must be set before that call. */
final class LoadedLibrary {
  static volatile Path path;

  private LoadedLibrary() {}
}
