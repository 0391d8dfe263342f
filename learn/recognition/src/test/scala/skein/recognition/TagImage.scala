package skein.recognition

import skein.airsim.{Image, Pixels, Shot}
import skein.rpc.Bytes
import skein.units.*

/** Draws a tag as a pinhole camera's image, with nine rays per pixel, on a ground of varying grey. */
object TagImage:
  private val patterns = AprilTags.dictionary()

  /** @param positionFrd position of the tag's middle, m
    * @param turned rotation about its vertical axis; at 0 it faces the camera
    */
  def apply(camera: Pinhole, id: Int, size: Double, positionFrd: Vector3, turned: Double): Image =
    val bytes = Array.tabulate(camera.width * camera.height * 3)(i =>
      (90 + (i / 3) % camera.width * 60 / camera.width).toByte
    )
    val (cos, sin)        = (math.cos(turned), math.sin(turned))
    val f                 = camera.focalPx
    def pixel(v: Vector3) = (camera.width / 2.0 + f * v.y / v.x, camera.height / 2.0 + f * v.z / v.x)
    // Along the tag to its right, and down.
    val right                       = Vector3(-sin, cos, 0)
    val normal                      = Vector3(cos, sin, 0)
    def dot(a: Vector3, b: Vector3) = a.x * b.x + a.y * b.y + a.z * b.z
    val paper   = size * 10 / 16 // half of its width: a white edge of one bit around the black border
    val corners =
      for u <- List(-paper, paper); v <- List(-paper, paper)
      yield pixel(positionFrd + right * u + Vector3(0, 0, v))
    val (xs, ys) = corners.unzip
    for
      y <- math.floor(ys.min).toInt.max(0) to math.ceil(ys.max).toInt.min(camera.height - 1)
      x <- math.floor(xs.min).toInt.max(0) to math.ceil(xs.max).toInt.min(camera.width - 1)
    do
      val at     = 3 * (y * camera.width + x)
      val ground = bytes(at) & 0xff
      var sum    = 0.0
      for i <- 0 until 3; j <- 0 until 3 do
        val ray = Vector3(
          1,
          (x + (i + 0.5) / 3 - camera.width / 2.0) / f,
          (y + (j + 0.5) / 3 - camera.height / 2.0) / f
        )
        val hit = ray * (dot(positionFrd, normal) / dot(ray, normal)) - positionFrd
        sum += shade(id, dot(hit, right) / size, hit.z / size).getOrElse(ground).toDouble
      for channel <- 0 until 3 do bytes(at + channel) = math.round(sum / 9).toByte
    Image(
      Shot("0"),
      camera.width,
      camera.height,
      Pixels.Bgr(Bytes(bytes, 0, bytes.length)),
      Vector3.Zero,
      Quaternion.Identity
    )

  /** Brightness at a position on the tag, −½ to ½ within its border. */
  private def shade(id: Int, u: Double, v: Double): Option[Int] =
    val (column, row) = (math.floor((u + 0.5) * 8).toInt, math.floor((v + 0.5) * 8).toInt)
    if column < -1 || column > 8 || row < -1 || row > 8 then None
    else if column == -1 || column == 8 || row == -1 || row == 8 then Some(230)
    else if column == 0 || column == 7 || row == 0 || row == 7 then Some(20)
    else Some(if patterns.encoding.get(id).pattern.get((row - 1) * 6 + column - 1) == 1 then 230 else 20)
