package skein.flight

import java.util.concurrent.atomic.LongAdder
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.KillSwitches
import org.apache.pekko.stream.scaladsl.{Keep, Sink, Source}
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future}
import skein.airsim.*
import skein.flow.*
import skein.link.*
import skein.rpc.{RpcClient, RpcSettings}
import skein.scene.SceneFile
import skein.signal.{ClockAlignment, Kinematics, LatencyProfile, Stamped}
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.units.*
import upack.{Bool, Str}

/** The transfer of images to the controller during the run. */
private enum Beside(val name: String):
  case Nothing     extends Beside("no images")
  case OwnLane     extends Beside("images on their own lane")
  case ControlLane extends Beside("images on control's lane")

/** A control loop of 20 ms (`Sense ~> Pace ~> Decide ~> Steer`) over real sockets, with and without a
  * concurrent transfer of raw images of 1280 × 720, in turns: on loopback at 30 Hz, and over an emulated line
  * of 50 Mbit/s with a round trip of 20 ms, which carries two images per second. Prints a reading's age when
  * its command leaves, and the time since its arrival:
  * `flight/Test/runMain skein.flight.controlBesideImages 20 3`.
  */
@main def controlBesideImages(seconds: Int, rounds: Int): Unit =
  given system: ActorSystem = ActorSystem("beside")
  given ExecutionContext    = ExecutionContext.parasitic
  val clock                 = Clock.system
  val transport             = TcpTransport()
  val vehicles              = Vector(VehicleSettings("Drone"))
  val text                  = ujson.read(WorldSettings.render(vehicles))
  text("CameraDefaults") = ujson.Obj(
    "CaptureSettings" -> ujson.Arr(ujson.Obj("ImageType" -> 0, "Width" -> 1280, "Height" -> 720))
  )
  val world = SimulatorSettings(
    WorldSettings(vehicles, text = text.render()),
    Address("127.0.0.1", 0),
    scene = SceneFile.named("street").get
  )

  def wait[A](what: Future[A]): A                 = Await.result(what, 60.seconds)
  def right[E, A](what: Future[Either[E, A]]): A  = wait(what).fold(e => sys.error(e.toString), identity)
  def quantile(sorted: Vector[Double], q: Double) = sorted((q * (sorted.size - 1)).round.toInt)
  def told(what: String, values: Vector[Double])  =
    val sorted = values.sorted
    f"$what p50 ${quantile(sorted, 0.5)}%.2f p99 ${quantile(sorted, 0.99)}%.2f most ${sorted.last}%.2f ms"

  def fly(over: String, line: Option[LatencyProfile], beside: Beside, imagesHz: Int): Unit =
    val server = wait(SimulatorServer.start(world, transport, clock))
    val proxy  = line.map: profile =>
      val link = EmulatedLink(LinkProfile.symmetric(profile), 1, clock)
      wait(LinkProxy.start(Address("127.0.0.1", 0), server.address, link, transport))
    val rpc =
      RpcClient(transport, proxy.fold(server.address)(_.address), clock, RpcSettings(controlConnections = 1))
    val client = AirSimClient(rpc)
    val drone  = right(Multirotor.named(client, "Drone"))
    right(drone.enableApiControl())
    right(drone.arm()): Unit
    right(drone.hoverAt(VehiclePose(Vector3(0, 0, -10), Quaternion.Identity)))
    val stop                = KillSwitches.shared("beside")
    val missed, came, bytes = LongAdder()
    val used                = Vector.newBuilder[(Stamped[Kinematics], Instant)]
    val period              = Span.ofMillis(20)
    val began               = clock.now()

    def image(): Future[Either[Any, Stamped[Int]]] = beside match
      case Beside.OwnLane => drone.eyes.image(Shot("0")).map(_.map(_.map(_.pixels match
          case Pixels.Bgr(pixels) => pixels.buffer.remaining
          case other              => throw IllegalStateException(s"$other"))))
      case _ =>
        val asked =
          upickle.default.writeMsg(Seq(wire.ImageRequest("0", 0, pixels_as_float = false, compress = false)))
        rpc.callStamped("simGetImages", Seq(asked, Str("Drone"), Bool(false))).map(_.map: answer =>
          val image = answer.value.arr.head.obj
          val at    = Instant.ofNanos(image(Str("time_stamp")).int64)
          Stamped(image(Str("image_data_uint8")).binary.length, at, answer.sentAt, answer.receivedAt))

    val images =
      if beside == Beside.Nothing then Future.unit
      else
        Frames
          .at(Source.fromGraph(Metronome(began, Span.ofSeconds(1.0 / imagesHz), clock)).via(stop.flow))(() =>
            image()
          )(_ =>
            missed.increment()
          )
          .runWith(Sink.foreach: frame =>
            came.increment()
            bytes.add(frame.value))
    val control = Sense
      .at(Source.fromGraph(Metronome(began, period, clock)).via(stop.flow))(() => drone.kinematics())(
        _ => (),
        _ => ()
      )
      .via(Pace(period / 2, clock)(_ => ()))
      .via(Decide.withMemory(0): (step, seen) =>
        val heading = 0.5 * step * period.toSeconds
        (step + 1, (seen, Vector3(3 * math.cos(heading), 3 * math.sin(heading), 0))))
      .via(Steer[(Stamped[Kinematics], Vector3), Any](period / 2, clock, mostOutstanding = 4)(
        send = (_, velocity) => drone.moveByVelocityZ(velocity, Metres(-10), Span.ofSeconds(5)),
        park = () => drone.hover()
      ))
      .toMat(Sink.foreach {
        case Steered.Sent((seen, _), at) => used += ((seen, at))
        case _                           => ()
      })(Keep.right)
      .run()
    Thread.sleep(seconds * 1000L)
    stop.shutdown()
    wait(control): Unit
    wait(images): Unit
    // The first second belongs to the start.
    val decided = used.result().filter((_, at) => at.since(began) > Span.ofSeconds(1))
    val clocks  =
      decided.tail.foldLeft(ClockAlignment.of(decided.head._1))((known, next) => known.updated(next._1))
    val ages = decided.map((seen, at) => at.since(clocks.toController(seen.validAt)).toMillis)
    val here = decided.map((seen, at) => at.since(seen.receivedAt).toMillis)
    println(
      f"$over%-22s ${beside.name}%-25s ${decided.size}%5d commands; ${told("age", ages)} (± " +
        f"${clocks.uncertainty.toMillis}%.2f); ${told("reading to command", here)}; " +
        f"${came.sum}%4d images of ${bytes.sum / came.sum.max(1)}%,d bytes, ${missed.sum} skipped"
    )
    wait(client.close()): Unit
    proxy.foreach(proxy => wait(proxy.close()))
    wait(server.close()): Unit

  val line =
    LatencyProfile.parse("rate:50mbit,constant:20ms", _ => Left("")).fold(e => sys.error(e.message), identity)
  try
    for round <- 0 to rounds do
      println(if round == 0 then "to warm up:" else s"round $round:")
      if round == 1 then println(s"${ControlThreads.lead()} threads go first")
      for beside <- Seq(Beside.Nothing, Beside.OwnLane) do fly("loopback", None, beside, 30)
      for beside <- Beside.values do fly("50 Mbit/s, 20 ms", Some(line), beside, 2)
  finally wait(system.terminate()): Unit
