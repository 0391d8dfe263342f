package skein.flight

import com.typesafe.config.ConfigFactory
import java.nio.file.{Files, Path}
import skein.loop.{LoopKind, FlightOutcome}
import skein.mujoco.MujocoHere
import skein.record.Recording
import skein.scenario.Scenarios
import skein.settings.{FlySettings, SimulatedBody}
import skein.units.*

/** Flights of `fly --plant mujoco:FILE.xml --clock virtual`, and its refusals. Runs if MuJoCo is installed,
  * or can be.
  */
class MujocoFlightLiveSuite extends MujocoHere:
  import MujocoFlightLiveSuite.*
  private given Scenarios = Scenarios.ours

  private def settings(plant: String, loops: LoopKind*): Either[String, FlySettings] =
    val told = s"""skein.fly {
      plant = "$plant", loops = ["${loops.map(_.label).mkString("\",\"")}"]
      links = [vpn], duration = 6 s, seed = 3
    }"""
    FlySettings.read(ConfigFactory.parseString(told).withFallback(ConfigFactory.load()))

  private def flown(plant: String, loop: LoopKind): Recording =
    val read   = settings(plant, loop).fold(fail(_), identity)
    val flight = VirtualFlights.fly(read, read.plans.head).fold(fail(_), identity)
    assertEquals(flight.landed.outcome, FlightOutcome.Completed, s"$plant, ${loop.label}")
    flight.recorder.recording

  private def tracks(recording: Recording): Map[String, Vector[Vector3]] =
    recording.readings.toVector.groupMap(_.vehicle)(_.state.value.positionNed)

  for loop <- Seq(LoopKind.Paused, LoopKind.Stream, LoopKind.Predictive) do
    test(s"AirSim's quadrotor as a model flies the duel nearly as the built-in one does: ${loop.label}"):
      assumeMujoco()
      val (theirs, ours) = (flown(example("quadrotor"), loop), flown(SimulatedBody.AirSim.text, loop))
      for (name, places) <- tracks(theirs) do
        val (at, other) = places.zip(tracks(ours)(name)).last
        val way         = (at - places.head).norm
        assert(way > 8, s"$name has flown $way m")
        // The air of both drags, each by its own formula.
        assert((at - other).norm < 0.1 * way, s"$name: at $at, not $other")
        assertNotEquals(places, tracks(ours)(name), "it is not MuJoCo's")
      assert(theirs.heading.parameter("plant").exists(_.endsWith(example("quadrotor"))))

  test("a repeated flight of a MuJoCo model is identical to the bit"):
    assumeMujoco()
    def again() = tracks(flown(example("slung-load"), LoopKind.Stream))
    assertEquals(again(), again())

  test("an unsupported model is refused before the flight, with its reason"):
    assumeMujoco()
    def refused(plant: String, reason: String) =
      assert(clue(settings(plant, LoopKind.Stream)).left.exists(_.contains(reason)), reason)
    refused("mujoco:nowhere.xml", "there is no nowhere.xml")
    refused("mujoco:", "expected a file of MuJoCo's XML")
    refused("bullet:quadrotor.xml", s"expected ${SimulatedBody.forms}, got 'bullet:quadrotor.xml'")
    val heavy = Files.createTempFile("heavy", ".xml")
    try
      val text = Files.readString(Path.of(example("quadrotor").stripPrefix("mujoco:")))
      Files.writeString(heavy, text.replace("mass=\"1\"", "mass=\"2\""))
      refused(s"mujoco:$heavy", "by which it hovers")
    finally Files.delete(heavy)

  test("external autopilots are refused for models whose steps do not match their sensors' steps"):
    assumeMujoco()
    val body = SimulatedBody.parse(example("quadrotor")).fold(fail(_), identity)
    assert(
      clue(body.refusesAutopilots).exists(_.contains("expected a timestep of 1 ms or a whole part of it"))
    )
    assertEquals(SimulatedBody.AirSim.refusesAutopilots, None)

private object MujocoFlightLiveSuite:
  private val root =
    Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at =>
      Files.exists(at.resolve("ARCHITECTURE.md"))
    ).get

  def example(name: String): String = s"mujoco:${root.resolve(s"examples/mujoco/$name.xml")}"
