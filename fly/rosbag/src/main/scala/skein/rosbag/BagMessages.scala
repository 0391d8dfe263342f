package skein.rosbag

import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.mutable
import skein.policy.Action
import skein.record.*
import skein.ros.message.*
import skein.ros.SensorMessages.token
import skein.ros.{RosFrames, SensorMessages, TwistCommand, VehicleMessages}
import skein.signal.Kinematics
import skein.units.{Instant, Vector3 as Ned}

/** A message of a bag.
  *
  * @param at when the controller received it, on its clock
  */
final case class BagMessage(topic: String, kind: MessageType[?], at: Instant, bytes: Array[Byte])

/** Converts the rows of a recording to messages of ROS 2, in the order of the rows.
  *
  *   - `/NAME/odom` (`nav_msgs/Odometry`) and `/tf`: readings;
  *   - `/NAME/cmd_vel` (`geometry_msgs/TwistStamped`, in the frame `map`): commands, in the form in which
  *     `fly --ros` sends them;
  *   - `/NAME/CAMERA/image_raw` (`sensor_msgs/Image`), `/NAME/LIDAR/points` (`sensor_msgs/PointCloud2`), each
  *     with its frame in `/tf`: images and scans.
  *
  * Headers are stamped with the time of sampling, converted to the controller's clock by the offset that was
  * known at that row. Frames are those of REP 103 and 105. Bytes that are not letters, digits or `_` in a
  * name become `_`.
  */
final class BagMessages(rows: Vector[Record]):
  private var offset  = McapRecording.firstOffset(rows)
  private val motions = mutable.Map.empty[String, Kinematics]
  private val actions = mutable.Map.empty[String, (Long, Action)]

  /** Every topic that has a message, in the order of first messages. */
  def all: Iterator[BagMessage] = rows.iterator.flatMap(of)

  private def of(row: Record): Vector[BagMessage] = row match
    case reading: ReadingRow =>
      val (vehicle, motion) = (token(reading.vehicle), reading.state.value)
      val (at, stamp)       = (reading.state.receivedAt, reading.state.validAt + offset)
      motions(reading.vehicle) = motion
      Vector(
        message(s"/$vehicle/odom", at, VehicleMessages.odometry(stamp, vehicle, motion)),
        frame(at, VehicleMessages.transform(stamp, vehicle, motion))
      )
    case decision: DecisionRow =>
      for known <- decision.trueAge do offset = known.clockOffset
      for action <- decision.action do actions(decision.vehicle) = (decision.sequence, action)
      Vector.empty
    case command: CommandRow => commanded(command).toVector
    case image: CameraImage  =>
      val (at, stamp) = (image.receivedAt, image.validAt + offset)
      val name        = s"${token(image.vehicle)}/${token(image.camera)}"
      val optical     = s"$name/optical"
      val header      = Header(Time.of(stamp), optical)
      Vector(
        frame(at, SensorMessages.optical(stamp, optical, image.positionNed, image.orientation)),
        message(
          s"/$name/image_raw",
          at,
          SensorMessages.image(
            header,
            image.width.toInt,
            image.height.toInt,
            image.encoding,
            image.pixels.bytes
          )
        )
      )
    case cloud: Cloud =>
      val (at, stamp) = (cloud.receivedAt, cloud.validAt + offset)
      val name        = s"${token(cloud.vehicle)}/${token(cloud.lidar)}"
      val seen        = ByteBuffer.wrap(cloud.xyz.bytes).order(ByteOrder.LITTLE_ENDIAN).asFloatBuffer
      val scan        = SensorMessages.points(Header(Time.of(stamp), name), seen.remaining / 3): number =>
        RosFrames.swapBody(Ned(seen.get(3 * number), seen.get(3 * number + 1), seen.get(3 * number + 2)))
      Vector(
        frame(
          at,
          VehicleMessages.transform(stamp, name, cloud.positionNed, RosFrames.toEnu(cloud.orientation))
        ),
        message(s"/$name/points", at, scan)
      )
    case _ => Vector.empty

  private def commanded(command: CommandRow): Option[BagMessage] =
    val level  = Action.VelocityAt(command.velocityNorth.value, command.velocityEast.value, command.down)
    val action = actions.get(command.vehicle) match
      case Some((decision, chosen)) if command.decision.contains(decision) => chosen
      case _                                                               => level
    for
      motion <- motions.get(command.vehicle)
      twist  <- TwistCommand.of(action, motion).toOption
    yield message(
      s"/${token(command.vehicle)}/cmd_vel",
      command.sentAt,
      TwistStamped(Header(Time.of(command.sentAt), VehicleMessages.World), twist)
    )

  private def frame(at: Instant, frame: TransformStamped) = message("/tf", at, TFMessage(Vector(frame)))

  private def message[A](topic: String, at: Instant, value: A)(using kind: MessageType[A]) =
    BagMessage(topic, kind, at, Cdr.bytes(value)(using kind.cdr))
