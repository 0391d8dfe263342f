package skein.ros

import java.util.concurrent.atomic.{AtomicBoolean, AtomicLong}
import java.util.concurrent.{Executors, TimeUnit}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.{AirSimClient, Encoding, Eyes, Image, ImageKind, Multirotor, Scan, Shot}
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.link.{Address, TcpTransport}
import skein.ros.message.{Image as ImageMessage, *}
import skein.rpc.{RpcClient, RpcError}
import skein.simulator.SensorSettings
import skein.units.{Clock as OwnClock, Expect, Instant, Radians, Span}

/** Cameras and lidars of a simulator's vehicles as topics: `/NAME/CAMERA/image_raw` with
  * `/NAME/CAMERA/camera_info`, both also below `depth` and `segmentation`, all of one instant; and
  * `/NAME/LIDAR/points`; each camera and lidar with its frame in `/tf`. They are requested every 100 ms of
  * simulated time, by AirSim's wire, while something subscribes. If the last image or scan of a sensor has
  * not arrived by then, one is left out, and counted.
  */
final class SimulatedSensors private (sensors: Vector[SimulatedSensors.Sensor], end: () => Unit)
    extends AutoCloseable:
  private var nextAt = Instant.Epoch

  /** Images and scans that were left out, because the sensor's last one had not arrived. */
  def skipped: Long = sensors.map(_.skipped.get).sum

  /** The first failure of each sensor, with its topic. */
  def notes: Vector[String] = sensors.flatMap(_.failure)

  /** To be called for each of the simulator's instants. */
  def look(at: Instant): Unit = if at >= nextAt then
    nextAt = at + SimulatedSensors.Every
    sensors.foreach(_.look())

  def close(): Unit = end()

object SimulatedSensors:
  private val Every = Span.ofMillis(100)

  private val Usual = "front_center"

  /** Opens the topics of the cameras that the settings list, or of `front_center`, and of the lidars.
    *
    * @param simulator the simulator's address
    * @param frames receives the transforms, if they are published
    * @return Left if ROS 2 cannot publish them
    */
  def open(
      node: RosNode,
      world: WorldSettings,
      simulator: Address,
      frames: TransformStamped => Unit
  )(using ActorSystem): Either[String, SimulatedSensors] =
    val carried = Carried.of(world)
    for
      _      <- Expect.each(carried)(mistake(_).toLeft(()))
      opened <- opened(node, carried, simulator, frames)
    yield opened

  /** A vehicle's sensors that are published.
    *
    * @param cameras names of the cameras
    * @param lidars names of the lidars, and whether their points are in their own frame
    */
  private[ros] final case class Carried(
      vehicle: VehicleSettings,
      cameras: Vector[String],
      lidars: Vector[(name: String, isLocal: Boolean)]
  )

  private[ros] object Carried:
    def of(world: WorldSettings): Vector[Carried] =
      val equipment = SensorSettings.of(world)
      world.vehicles.map: vehicle =>
        Carried(
          vehicle,
          equipment.cameras.get(vehicle.name).filter(_.nonEmpty).fold(Vector(Usual))(_.keys.toVector.sorted),
          equipment.lidars.of(vehicle).map((name, lidar) => (name = name, isLocal = lidar.sensorFrame))
        )

  /** Why the names of a vehicle's sensors cannot be those of topics and frames, if they cannot. */
  private[ros] def mistake(carried: Carried): Option[String] =
    val names = carried.cameras ++ carried.lidars.map(_.name)
    names.groupBy(SensorMessages.token).collectFirst:
      case (token, all) if all.sizeIs > 1 || token == "base_link" =>
        s"expected cameras and lidars of ${carried.vehicle.name} whose names differ in letters and digits, and none " +
          s"called base_link, got ${all.mkString("'", "', '", "'")}"

  private def opened(
      node: RosNode,
      all: Vector[Carried],
      simulator: Address,
      frames: TransformStamped => Unit
  )(using ActorSystem): Either[String, SimulatedSensors] =
    val client = AirSimClient(RpcClient(TcpTransport(), simulator, OwnClock.system))
    val thread =
      Executors.newSingleThreadExecutor(Thread.ofPlatform().daemon().name("skein-ros-sensors").factory())
    given ExecutionContext = ExecutionContext.fromExecutor(thread)
    def end(): Unit        =
      client.close(): Unit
      thread.shutdown()
      thread.awaitTermination(2, TimeUnit.SECONDS): Unit
    val made =
      for
        Carried(vehicle, cameras, lidars) <- all
        eyes = Multirotor(client, vehicle.name, vehicle.startNed).eyes
        sensor <-
          cameras.map(camera(node, eyes, vehicle.name, _, frames)) ++
            lidars.map(each => lidar(node, eyes, vehicle, each.name, each.isLocal, frames))
      yield sensor
    Expect.each(made)(identity) match
      case Right(sensors) => Right(SimulatedSensors(sensors, () => end()))
      case Left(why)      =>
        end()
        Left(why)

  /** A kind of images of a camera.
    *
    * @param below path of the topics below the camera's path
    */
  private enum Sight(val below: String, val kind: ImageKind, val encoding: Encoding):
    case Colour       extends Sight("", ImageKind.Scene, Encoding.Raw)
    case Depth        extends Sight("depth/", ImageKind.DepthPlanar, Encoding.Numbers)
    case Segmentation extends Sight("segmentation/", ImageKind.Segmentation, Encoding.Raw)

  private final class SightTopics(
      val sight: Sight,
      images: RosPublisher[ImageMessage],
      infos: RosPublisher[CameraInfo]
  ):
    def isRead: Boolean = images.isRead || infos.isRead

    def publish(header: Header, image: Image, fov: Radians): Unit =
      for message <- SensorMessages.image(header, image) do
        infos.publish(SensorMessages.cameraInfo(header, image.width, image.height, fov))
        images.publish(message)

  private def camera(
      node: RosNode,
      eyes: Eyes,
      vehicle: String,
      camera: String,
      frames: TransformStamped => Unit
  )(using ExecutionContext): Either[String, Sensor] =
    val name  = s"$vehicle/${SensorMessages.token(camera)}"
    val frame = s"$name/optical"
    val made  = Expect.each(Sight.values.toVector): sight =>
      for
        images <- node.publish[ImageMessage](s"/$name/${sight.below}image_raw")
        infos  <- node.publish[CameraInfo](s"/$name/${sight.below}camera_info")
      yield SightTopics(sight, images, infos)
    made.map: all =>
      def take(): Future[Either[RpcError, Unit]] =
        val read  = all.filter(_.isRead)
        val shots = read.map(topics => Shot(camera, topics.sight.kind, topics.sight.encoding))
        if read.isEmpty then Future.successful(Right(()))
        else
          eyes.images(shots).zip(eyes.fov(camera)).map: (taken, fov) =>
            for images <- taken; angle <- fov do
              val (at, first) = (images.validAt, images.value.head)
              frames(SensorMessages.optical(at, frame, first.positionNed, first.orientation))
              for (topics, image) <- read.zip(images.value) do
                topics.publish(Header(Time.of(at), frame), image, angle)
            taken.map(_ => ())
      Sensor(name, () => all.exists(_.isRead), () => take())

  private def lidar(
      node: RosNode,
      eyes: Eyes,
      vehicle: VehicleSettings,
      lidar: String,
      isLocal: Boolean,
      frames: TransformStamped => Unit
  )(using ExecutionContext): Either[String, Sensor] =
    val name = s"${vehicle.name}/${SensorMessages.token(lidar)}"
    for clouds <- node.publish[PointCloud2](s"/$name/points") yield
      var shownAt                             = Instant.Epoch
      def show(scan: Scan, at: Instant): Unit = if at > shownAt then
        shownAt = at
        val (placed, cloud) = SensorMessages.scan(scan, at, name, isLocal, vehicle.startNed)
        placed.foreach(frames)
        clouds.publish(cloud)
      Sensor(
        name,
        () => clouds.isRead,
        () => eyes.scan(lidar).map(_.map(taken => show(taken.value, taken.validAt)))
      )

  /** @param isRead whether something subscribes to it
    * @param take takes an image or a scan, and publishes it
    */
  private final class Sensor(
      name: String,
      isRead: () => Boolean,
      take: () => Future[Either[RpcError, Unit]]
  )(using
      ExecutionContext
  ):
    private val isBusy                    = AtomicBoolean(false)
    val skipped                           = AtomicLong()
    @volatile var failure: Option[String] = None

    def look(): Unit =
      // A publisher in use is not queried, since that would wait for it.
      if isBusy.get then skipped.incrementAndGet(): Unit
      else if isRead() then
        isBusy.set(true)
        take().onComplete: taken =>
          for
            why <- taken.fold(error => Some(error.toString), _.left.toOption.map(_.message))
            if failure.isEmpty
          do
            failure = Some(s"/$name: $why")
          isBusy.set(false)
