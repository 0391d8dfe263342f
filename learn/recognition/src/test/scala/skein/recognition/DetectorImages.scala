package skein.recognition

import java.io.{BufferedOutputStream, OutputStream}
import java.nio.charset.StandardCharsets.US_ASCII
import java.nio.file.{Files, Path}
import java.nio.{ByteBuffer, ByteOrder}
import scala.util.Using
import skein.units.*

/** Draws the images with which `examples/onnx-detector` trains the detector, as NumPy files:
  * `recognition/Test/runMain skein.recognition.drawDetectorImages FOLDER COUNT SEED`. They are every second
  * pixel of a camera of 800×600 and 100°, cut to 160×120.
  */
@main def drawDetectorImages(folder: String, count: Int, seed: Long): Unit =
  val (width, height) = (160, 120)
  val focalPx         = Pinhole(400, 300, Radians(StrictMath.toRadians(100))).focalPx
  val camera          = Pinhole(width, height, Radians(2 * StrictMath.atan(width / 2.0 / focalPx)))
  val images          = DroneImages(camera, seed)
  Files.createDirectories(Path.of(folder)): Unit
  Using.resources(
    npy(Path.of(folder, "images.npy"), "|u1", s"($count, $height, $width, 3)"),
    npy(Path.of(folder, "truth.npy"), "<f4", s"($count, 5)")
  ): (pixels, truths) =>
    for _ <- 1 to count do
      val image = images.next()
      val row   = ByteBuffer.allocate(20).order(ByteOrder.LITTLE_ENDIAN)
      val known = if image.positionFrd.isEmpty then 0 else if image.isPlain then 1 else -1
      row.putFloat(known.toFloat)
      for box <- image.box do
        row.putFloat((box.left + box.right) / 2f).putFloat((box.top + box.bottom) / 2f)
        row.putFloat((box.right - box.left).toFloat).putFloat((box.bottom - box.top).toFloat)
      pixels.write(image.bgr)
      truths.write(row.array)

/** Writes the header of NumPy's format, version 1.0. */
private def npy(file: Path, kind: String, shape: String): OutputStream =
  val out  = BufferedOutputStream(Files.newOutputStream(file), 1 << 16)
  val told = s"{'descr': '$kind', 'fortran_order': False, 'shape': $shape, }"
  val head = told.padTo(128 - 10 - 1, ' ') + "\n"
  out.write(Array(0x93.toByte) ++ "NUMPY".getBytes(US_ASCII) ++ Array[Byte](1, 0, head.length.toByte, 0))
  out.write(head.getBytes(US_ASCII))
  out
