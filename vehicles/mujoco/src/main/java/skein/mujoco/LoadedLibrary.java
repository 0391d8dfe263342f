package skein.mujoco;

import java.nio.file.Path;

/** Which library {@link MujocoCalls} loads when it is first called: to be set before. */
final class LoadedLibrary {
  static volatile Path path;

  private LoadedLibrary() {}
}
