package skein.onnx

import java.nio.file.{Files, Path}
import skein.policy.PlanarObservation
import skein.scenario.Scenarios
import skein.signal.SplitMix64
import skein.testing.TemporaryFolders

/** Files of models, and observations of their policies. */
trait OnnxFiles extends TemporaryFolders:
  protected given Scenarios = Scenarios.ours

  protected val seed = 20261122L

  protected def written(folder: Path, bytes: Array[Byte]): String =
    Files.write(folder.resolve("policy.onnx"), bytes).toString

  /** A random observation.
    *
    * @param longestS largest time since the last decision, and largest age
    */
  protected def seen(random: SplitMix64, longestS: Double): PlanarObservation =
    def number(most: Double) = most * (2 * random.nextDouble() - 1)
    def time()               = longestS * random.nextDouble()
    PlanarObservation(
      number(30),
      number(30),
      number(10),
      number(10),
      number(4),
      number(4),
      time(),
      time(),
      time()
    )
