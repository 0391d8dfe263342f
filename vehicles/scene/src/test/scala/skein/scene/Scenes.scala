package skein.scene

import skein.signal.SplitMix64
import skein.units.Vector3

/** Scenes for tests and measurements. */
private[skein] object Scenes:

  /** Randomly placed boxes, some intersecting each other, north of the origin. */
  def boxes(count: Int, seed: Long): Scene =
    val random                      = SplitMix64(seed)
    def among(a: Double, b: Double) = a + (b - a) * random.nextDouble()
    Scene(Vector.tabulate(count): i =>
      val half = Vector3(among(0.3, 2.5), among(0.3, 2.5), among(0.3, 4))
      SceneObject(
        s"Box$i",
        Shape.Box(half),
        Placement.turned(
          Vector3(among(4, 60), among(-30, 30), -half.z),
          among(-20, 20),
          among(-20, 20),
          among(0, 360)
        ),
        random.nextInt(1 << 24),
        None
      ))

  val Sixty: Moment = Moment(boxes(60, seed = 1), Vector.empty)
