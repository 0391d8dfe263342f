package skein.airsim.wire

import skein.rpc.{Encoded, MessageWriter}
import skein.units.Instant
import upack.Binary
import upickle.default.writeMsg

/** A request for one image; `image_type` is an `ImageKind`'s number. Cosys-AirSim's additional key is left
  * out; its server does not need it.
  */
final private[skein] case class ImageRequest(
    camera_name: String,
    image_type: Int,
    pixels_as_float: Boolean,
    compress: Boolean
) derives Fields

/** One image of an answer.
  *
  * @param image_data_uint8 a PNG file if `compress`, else three bytes per pixel (blue, green, red), rows from
  *   the top, without gaps; empty if `pixels_as_float`
  * @param image_data_float one value per pixel, rows from the top; empty unless `pixels_as_float`
  * @param camera_position the camera's position in the frame of its vehicle, NED, m
  * @param time_stamp time of exposure, on the simulator's clock
  */
final private[skein] case class ImageResponse(
    image_data_uint8: Array[Byte] = Array.emptyByteArray,
    image_data_float: Array[Float] = Array.emptyFloatArray,
    camera_position: Vector3r = Vector3r.Zero,
    camera_name: String = "",
    camera_orientation: Quaternionr = Quaternionr(1, 0, 0, 0),
    time_stamp: Instant = Instant.Epoch,
    message: String = "",
    pixels_as_float: Boolean = false,
    compress: Boolean = true,
    width: Int = 0,
    height: Int = 0,
    image_type: Int = 0
) derives Fields

private[skein] object ImageResponse:

  /** Encodes the answer to `simGetImages`, keys in AirSim's order. Bytes are sent from their arrays, without
    * a copy.
    */
  def encode(images: Seq[ImageResponse]): Encoded = MessageWriter.encode: out =>
    out.array(images.size)
    for image <- images do
      val small = image.copy(Array.emptyByteArray, Array.emptyFloatArray)
      out.structure(writeMsg(small)):
        case "image_data_uint8" => out.value(Binary(image.image_data_uint8))
        case "image_data_float" => out.floats(image.image_data_float)
