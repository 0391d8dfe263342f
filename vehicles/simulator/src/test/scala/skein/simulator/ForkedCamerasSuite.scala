package skein.simulator

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.wire.{CameraInfo, ImageResponse, Pose, ProjectionMatrix, Quaternionr, Vector3r}
import skein.airsim.{AirSimClient, Multirotor, Shot, VehicleSettings, WorldSettings}
import skein.link.{Address, MemoryNetwork, NetworkPlan}
import skein.rpc.{RpcClient, RpcServer, Rpclib}
import skein.units.*
import skein.vtime.VirtualTime
import upickle.default.writeMsg

/** Cameras of a server whose functions lack `external`, as in Cosys-AirSim 3. */
class ForkedCamerasSuite extends munit.FunSuite:
  private val address = Address("simulator", 41451)

  /** Requests three images and a field of view from a server whose camera functions take `takes` arguments.
    * Returns the results, and the numbers of arguments in the calls.
    */
  private def asked(takes: Int): (Vector[Boolean], Option[Double], Vector[Int]) = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock   = Clock.ofNanos(VirtualTime.clock(system))
      val network = MemoryNetwork(NetworkPlan(), 1, clock)
      var counts  = Vector.empty[Int]
      val image   = ImageResponse(
        image_data_uint8 = Array.fill(6)(7.toByte),
        camera_position = Vector3r.Zero,
        camera_name = "0",
        camera_orientation = Quaternionr(1, 0, 0, 0),
        time_stamp = Instant.ofNanos(1),
        width = 2,
        height = 1
      )
      val info = CameraInfo(Pose(Vector3r.Zero, Quaternionr(1, 0, 0, 0)), 60, ProjectionMatrix(Seq.empty))
      val text = WorldSettings.render(Seq(VehicleSettings("A")))
      for
        server <- RpcServer.bind(network.host("simulator"), address): request =>
          val camera = request.method.startsWith("simGetImages") || request.method == "simGetCameraInfo"
          if camera then counts :+= request.params.size
          Future.successful:
            if camera && request.params.size != takes then
              Left(Rpclib.arity(request.method, passed = request.params.size, wanted = takes))
            else
              request.method match
                case "simGetImages"      => Right(ImageResponse.encode(Seq(image)))
                case "simGetCameraInfo"  => Right(writeMsg(info))
                case "listVehicles"      => Right(writeMsg(Seq("A")))
                case "getSettingsString" => Right(writeMsg(text))
                case other               => Left(Rpclib.unknown(other, request.params.size))
        client = AirSimClient(RpcClient(network.host("controller"), address, clock), Span.ofMillis(500))
        eyes   = Multirotor(client, "A").eyes
        first  <- eyes.image(Shot("0"))
        second <- eyes.image(Shot("0"))
        third  <- eyes.image(Shot("0"))
        fov    <- eyes.fov("0")
        _      <- client.close()
        _      <- server.close()
      yield (
        Vector(first, second, third).map(_.isRight),
        fov.toOption.map(angle => math.toDegrees(angle.value)),
        counts
      )
    .value

  test("a call refused for its number of arguments is repeated in the other form, once for each client"):
    val (images, fov, counts) = asked(takes = 2)
    assertEquals(images, Vector(true, true, true))
    assertEqualsDouble(fov.get, 60, 1e-3)
    assertEquals(counts, Vector(3, 2, 2, 2, 2))

  test("AirSim's own form is kept if it is accepted, and another error is reported in the server's words"):
    assertEquals(asked(takes = 3)._3, Vector(3, 3, 3, 3))
    assertEquals(asked(takes = 5)._1, Vector(false, false, false))
