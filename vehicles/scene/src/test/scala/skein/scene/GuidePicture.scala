package skein.scene

import java.nio.file.{Files, Path}
import skein.scene.render.*
import skein.units.Vector3

/** Draws the picture of `docs/guides/cameras.md`:
  * `scene/Test/runMain skein.scene.guidePicture docs/pictures/street.png`.
  */
@main def guidePicture(file: String): Unit =
  val view = View(Placement.turned(Vector3(0, -1.5, -4), 0, -4, 3), 640, 360, 80)
  Renderer.draw(
    Moment(SceneFile.named("street").get, Vector.empty),
    view,
    Set(Kind.Scene),
    identity
  )(Kind.Scene) match
    case Raster.Bytes(bgr) =>
      val _ = Files.write(Path.of(file), PngEncoder.encode(bgr, view.width, view.height))
    case other => throw IllegalStateException(s"$other")
