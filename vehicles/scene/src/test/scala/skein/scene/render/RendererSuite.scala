package skein.scene.render

import java.io.ByteArrayInputStream
import java.security.MessageDigest
import javax.imageio.ImageIO
import skein.scene.*
import skein.signal.SplitMix64
import skein.units.Vector3

class RendererSuite extends munit.FunSuite:
  private def eye(seed: Int) =
    View(
      Placement.turned(Vector3(0, 0, -2 - seed % 5), seed * 7 % 20, seed * 5 % 30 - 20, seed * 11 % 40 - 20),
      320,
      180,
      90
    )

  private def draw(moment: Moment, view: View, kinds: Kind*) =
    Renderer.draw(moment, view, kinds.toSet, idOf = item => 1 + item)

  private def bgr(images: Map[Kind, Raster], kind: Kind) = images(kind) match
    case Raster.Bytes(bytes) => bytes
    case other               => fail(s"$kind came as $other")

  private def numbers(images: Map[Kind, Raster], kind: Kind) = images(kind) match
    case Raster.Numbers(values) => values
    case other                  => fail(s"$kind came as $other")

  test("every pixel shows the item that a ray through its middle hits, at its distance"):
    for seed <- 1 to 6 do
      val moment = Moment(Scenes.boxes(40, seed), Vector.empty)
      val view   = eye(seed)
      val images = draw(moment, view, Kind.DepthPerspective, Kind.DepthPlanar, Kind.Infrared)
      val far    = numbers(images, Kind.DepthPerspective)
      val planar = numbers(images, Kind.DepthPlanar)
      val ids    = bgr(images, Kind.Infrared)
      val rays   = Rays(moment, view.place.position, 1e5, Item.Nothing)
      var others = 0
      for y <- 0 until view.height by 3; x <- 0 until view.width by 3 do
        val own     = Vector3(view.focalPx, x + 0.5 - view.width / 2.0, y + 0.5 - view.height / 2.0)
        val way     = view.place.turned(own * (1 / own.norm))
        val met     = rays.cast(way.x, way.y, way.z)
        val pixel   = y * view.width + x
        val same    = (ids(3 * pixel) & 0xff) == (if met.isInfinite || met > 15_000 then 0 else 1 + rays.item)
        val distant = if met > 15_000 then far(pixel) > 15_000 else math.abs(far(pixel) / met - 1) < 1e-4
        if !(same && distant) then others += 1
        if far(pixel) < 15_000 then
          val ratio = view.focalPx / own.norm
          assert(math.abs(planar(pixel) / (far(pixel) * ratio) - 1) < 1e-4)
      // Where an edge goes through a pixel's very middle, rounding decides.
      assert(others <= 2, s"seed $seed: $others pixels differ")

  test("equal scenes and views give equal bytes, on every machine"):
    val view   = View(Placement.turned(Vector3(0, 0, -3), 2, -5, 10), 320, 180, 90)
    val kinds  = Kind.values.toSeq
    val images = draw(Moment(Scenes.boxes(60, seed = 1), Vector.empty), view, kinds*)
    val digest = MessageDigest.getInstance("SHA-256")
    for kind <- kinds do
      images(kind) match
        case Raster.Bytes(bytes)    => digest.update(bytes)
        case Raster.Numbers(values) =>
          val bytes = java.nio.ByteBuffer.allocate(4 * values.length)
          values.foreach(bytes.putFloat)
          digest.update(bytes.array)
    digest.update(PngEncoder.encode(bgr(images, Kind.Scene), 320, 180))
    assertEquals(digest.digest.map(b => f"$b%02x").mkString.take(16), "31eaba862189aeaf")

  test("an image drawn together with other kinds equals one drawn alone"):
    val kinds = Seq(Kind.Scene, Kind.Segmentation, Kind.SurfaceNormals)
    val all   = draw(Scenes.Sixty, eye(3), kinds*)
    for kind <- kinds do
      assert(bgr(all, kind).sameElements(bgr(draw(Scenes.Sixty, eye(3), kind), kind)), s"$kind")

  test("the sky is beyond everything, and the camera's carrier is not drawn"):
    val up = View(Placement.turned(Vector3(0, 0, -2), 0, 90, 0), 16, 16, 60)
    assertEquals(numbers(draw(Scenes.Sixty, up, Kind.DepthPlanar), Kind.DepthPlanar).toSet, Set(65504f))
    val lone = Moment(
      Scene(Vector(SceneObject("A", Shape.Box(Vector3(1, 1, 1)), Placement(Vector3(5, 0, -2)), 0, None))),
      Vector.empty
    )
    val view  = View(Placement(Vector3(0, 0, -2)), 64, 64, 60)
    val with1 = Renderer.extents(lone, view)
    assertEquals(with1.map(_.item), Vector(Item.Ground, 1))
    assertEquals(Renderer.extents(lone, view, except = 1).map(_.item), Vector(Item.Ground))
    // A square of 2 m at 4 m: half of the visible width there is 4·tan 30°.
    val half = 32 / (4 * math.tan(math.Pi / 6))
    assertEqualsDouble(with1(1).right - with1(1).left, 2 * half, 1.01)
    assertEqualsDouble(with1(1).bottom - with1(1).top, 2 * half, 1.01)

  test("a camera that stands on the ground sees it in its lower half, wherever it looks"):
    for z <- Seq(0.0, 0.001, -0.001, -0.02); pitchDeg <- Seq(0.0, -40.0, -90.0) do
      val view   = View(Placement.turned(Vector3(3, 4, z), 0, pitchDeg, 30), 64, 36, 90)
      val images = draw(Moment(Scene.Empty, Vector.empty), view, Kind.Infrared, Kind.DepthPlanar)
      val ids    = bgr(images, Kind.Infrared)
      val depth  = numbers(images, Kind.DepthPlanar)
      for y <- view.height / 2 until view.height; x <- 0 until view.width; pixel = y * view.width + x do
        assertEquals(ids(3 * pixel).toInt, 1, s"z = $z, pitch $pitchDeg, pixel $x, $y")
        assert(depth(pixel) >= 0 && depth(pixel) < 3, s"${depth(pixel)}")

  test("a tag is drawn with its family's pattern, the right way up"):
    val tag =
      SceneObject("T", Shape.Tag(3, 0.8), Placement.turned(Vector3(2, 0, -2), 0, 0, 180), 0xffffff, None)
    val view  = View(Placement(Vector3(0, 0, -2)), 200, 200, 53.130102354) // 2 m across at 2 m
    val bytes = bgr(draw(Moment(Scene(Vector(tag)), Vector.empty), view, Kind.Scene), Kind.Scene)
    val cells = AprilTag.pattern(3)
    for row <- 0 until AprilTag.Cells; column <- 0 until AprilTag.Cells do
      // A cell is 0.1 m, 10 pixels; the plate's upper left corner is at pixel 50, 50.
      val at = 3 * ((50 + 10 * row + 5) * 200 + 50 + 10 * column + 5)
      assertEquals(
        (bytes(at) & 0xff) > 100,
        cells(row * AprilTag.Cells + column),
        s"row $row, column $column"
      )

  test("an independent reader reads a PNG back as it was drawn"):
    val random = SplitMix64(5)
    val noise  = Array.fill(3 * 31 * 17)(random.nextInt(256).toByte)
    val stripe = Array.tabulate(3 * 600 * 5)(i => (i / 3 % 600 / 7).toByte)
    val drawn  = bgr(draw(Scenes.Sixty, eye(2), Kind.DepthVis), Kind.DepthVis)
    val colour = bgr(draw(Scenes.Sixty, eye(2), Kind.Scene), Kind.Scene)
    for (pixels, width, height) <-
        Seq((noise, 31, 17), (stripe, 600, 5), (drawn, 320, 180), (colour, 320, 180))
    do
      val read = ImageIO.read(ByteArrayInputStream(PngEncoder.encode(pixels, width, height)))
      assertEquals((read.getWidth, read.getHeight), (width, height))
      for y <- 0 until height; x <- 0 until width do
        val at  = 3 * (y * width + x)
        val rgb = (pixels(at + 2) & 0xff) << 16 | (pixels(at + 1) & 0xff) << 8 | pixels(at) & 0xff
        if (read.getRGB(x, y) & 0xffffff) != rgb then fail(s"$x, $y of $width × $height")
