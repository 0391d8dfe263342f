package skein.scene

import java.lang.management.ManagementFactory
import java.util.zip.CRC32
import skein.scene.render.*
import skein.units.Vector3

/** CPU time of images and scans, with a witness of the drawn bytes: `scene/Test/runMain skein.scene.speed`.
  */
@main def speed(): Unit =
  val threads = ManagementFactory.getThreadMXBean
  val view    = View(Placement.turned(Vector3(0, 0, -3), 2, -5, 10), 1280, 720, 90)
  val forest  = Moment(SceneFile.named("forest").get, Vector.empty)

  def row(name: String)(work: => Long): Unit =
    var witness = 0L
    for _ <- 1 to 60 do witness = work
    val rounds = Seq.fill(5):
      val before = threads.getCurrentThreadCpuTime
      for _ <- 1 to 40 do witness = work
      (threads.getCurrentThreadCpuTime - before) / 40e6
    println(
      f"$name%-44s ${rounds.min}%7.3f ms least, ${rounds.sorted.apply(2)}%7.3f median; witness $witness%x"
    )

  def crc(bytes: Array[Byte]): Long =
    val sum = CRC32()
    sum.update(bytes, 0, math.min(bytes.length, 4096))
    sum.getValue

  def draw(moment: Moment, kinds: Kind*): Long =
    Renderer.draw(moment, view, kinds.toSet, item => item & 255).values.map:
      case Raster.Bytes(bytes)    => crc(bytes)
      case Raster.Numbers(values) => values(values.length / 2).toInt.toLong
    .sum

  row("1280 × 720, 60 boxes: Scene")(draw(Scenes.Sixty, Kind.Scene))
  row("  Scene, DepthPlanar, Segmentation")(draw(
    Scenes.Sixty,
    Kind.Scene,
    Kind.DepthPlanar,
    Kind.Segmentation
  ))
  row("  DepthPerspective")(draw(Scenes.Sixty, Kind.DepthPerspective))
  row("  forest: Scene")(draw(forest, Kind.Scene))
  val scene = Renderer.draw(Scenes.Sixty, view, Set(Kind.Scene), identity)(Kind.Scene) match
    case Raster.Bytes(bytes) => bytes
    case _                   => Array.emptyByteArray
  row(s"  PNG of Scene")(PngEncoder.encode(scene, 1280, 720).length)
  val lidar = Lidar()
  row("lidar, a turn of 10,000 rays, 60 boxes"):
    lidar.scan(Scenes.Sixty, Placement(Vector3(20, 0, -5)), Item.Nothing, Vector3.Zero, 0).items.length
