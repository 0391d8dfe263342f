package skein.mujoco

import java.nio.file.{Files, Path}
import scala.collection.concurrent.TrieMap
import skein.policy.Action
import skein.testing.Waiting
import skein.units.{Metres, Vector3}
import skein.vehicle.*

/** MuJoCo models as bodies, controlled by AirSim's flight controller. */
class MujocoRotorcraftLiveSuite extends MujocoHere, Waiting:
  import MujocoRotorcraftLiveSuite.*

  private def flying(name: String)(body: => Unit): Unit = test(name):
    assumeMujoco()
    body

  flying("a model of AirSim's quadrotor hovers, and turns within 0.8 m of the built-in one over 100 m"):
    val rotorcraft     = MujocoRotorcraft(example("quadrotor"))
    val (theirs, ours) = (QuadrotorState(), QuadrotorState())
    val quadrotor      = Quadrotor.AirSim
    for (one, state) <- Seq(rotorcraft -> theirs, quadrotor -> ours) do
      one.hover(state, Vector3(0, 0, -20), 0, Environment.Calm)
    var apart = 0.0
    for turn <- 0 until 10; _ <- 0 until (2 / rotorcraft.stepS).round.toInt do
      val goal = Setpoint.velocityZ(5 * math.cos(turn), 5 * math.sin(turn), -20)
      rotorcraft.step(theirs, goal, Environment.Calm)
      quadrotor.step(ours, goal, Environment.Calm)
      apart = apart.max((theirs.positionNed - ours.positionNed).norm)
    // The air of both drags, each by its own formula.
    assert(apart < 0.8, s"$apart m apart")

  flying("a vehicle that has hovered for a long time keeps its position"):
    for (name, steps) <- Seq("quadrotor" -> 3000, "slung-load" -> 4000) do
      val rotorcraft = MujocoRotorcraft(example(name))
      val state      = QuadrotorState()
      rotorcraft.hover(state, Vector3(3, -4, -20), 0.5, Environment.Calm)
      for _ <- 1 to steps do rotorcraft.step(state, Setpoint.hold(Vector3(3, -4, -20)), Environment.Calm)
      val off = (state.positionNed - Vector3(3, -4, -20 + rotorcraft.hoverSagM(-20))).norm
      assert(off < 0.002, s"$name: $off m off")

  flying("a load that hangs from a vehicle swings when it brakes, and moves the vehicle"):
    val rotorcraft = MujocoRotorcraft(example("slung-load"))
    val state      = QuadrotorState()
    rotorcraft.hover(state, Vector3(0, 0, -20), 0, Environment.Calm)
    def fly(seconds: Double, goal: Setpoint): Vector[Double] =
      Vector.fill((seconds / rotorcraft.stepS).round.toInt):
        rotorcraft.step(state, goal, Environment.Calm)
        state.ax
    fly(6, Setpoint.velocity(5, 0, 0))
    val braking = fly(6, Setpoint.velocity(0, 0, 0)).drop((3 / rotorcraft.stepS).toInt)
    // When the controller alone would be at rest, the load still pulls to both sides.
    assert(braking.max > 0.05 && braking.min < -0.05, s"${braking.min} to ${braking.max} m/s²")

  flying("a vehicle stands, takes off, lands and stands again on the world's ground, not the model's"):
    val rotorcraft  = MujocoRotorcraft(example("quadrotor"))
    val state       = QuadrotorState()
    val environment = Environment(groundDownM = 2)
    rotorcraft.land(state, 0)
    state.place(Vector3(0, 0, 2), state.orientation)
    def fly(seconds: Double, goal: Setpoint): Unit =
      for _ <- 0 until (seconds / rotorcraft.stepS).toInt do rotorcraft.step(state, goal, environment)
    fly(1, Setpoint.Armed)
    assertEquals(state.positionNed, Vector3(0, 0, 2))
    fly(8, Setpoint.velocityZ(1, 0, -5))
    assertEqualsDouble(state.z, -5, 0.1)
    assert(state.x > 3, state.x)
    fly(20, Setpoint.velocity(0, 0, 0.5))
    assert(state.grounded && state.contacts > 0, s"$state, ${state.positionNed}")
    assertEquals(state.z, 2.0)

  flying("wind drags a vehicle by the air density that its model states"):
    def drift(model: MujocoModel) =
      val rotorcraft = MujocoRotorcraft(model)
      val state      = QuadrotorState()
      rotorcraft.hover(state, Vector3(0, 0, -20), 0, Environment.Calm)
      val level = Setpoint.anglesZ(0, 0, 0, -20)
      for _ <- 1 to 1000 do rotorcraft.step(state, level, Environment(windNed = Vector3(8, 0, 0)))
      state.x
    val (blown, still) = (drift(example("quadrotor")), drift(changed("density=\"1.2\"", "density=\"0\"")))
    assert(blown > 0.5, blown)
    assertEqualsDouble(still, 0, 1e-6)

  flying("the vehicles of a batch fly as a single one does, to the bit"):
    val response = MujocoResponse(example("quadrotor"))
    val together = response.together(6)
    val alone    = Vector.tabulate(6)(_ => response.create())
    for place <- 0 until 6 do
      together.hover(place, -20)
      alone(place).start(0, 0, -20)
    for step <- 0 until 3000 do
      if step % 100 == 0 then
        for place <- 0 until 6 do
          val (north, east) = ((place + step % 7).toFloat, (3 - place).toFloat)
          together.command(place, north, east, -20)
          alone(place).act(Action.VelocityAt(north, east, Metres(-20)))
      together.step()
      for place <- 0 until 6 do alone(place).advance((step + 1) * response.stepS)
    for place <- 0 until 6 do
      val state = QuadrotorState()
      together.read(place, state)
      assertEquals((state.x, state.y), (alone(place).x, alone(place).y))
      assert(state.x.abs > 1, state.x)

  flying("a direct rotor control is a fraction of its actuator's range"):
    val rotorcraft = MujocoRotorcraft(example("slung-load"))
    val state      = QuadrotorState()
    rotorcraft.hover(state, Vector3(0, 0, -20), 0, Environment.Calm)
    // Those at the right push up: it rolls to the left.
    for _ <- 1 to 20 do rotorcraft.step(state, Setpoint.rotors(0.6, 0.4, 0.4, 0.6), Environment.Calm)
    assert(state.wx < -0.3, state.angularVelocityFrd)
    assertEqualsDouble(state.wy, 0, 0.05)

  flying("MuJoCo's memory is freed once its models are unreachable"):
    val before = NativeMemory.freed
    for _ <- 1 to 3 do
      val rotorcraft = MujocoRotorcraft(read(path("quadrotor")))
      val state      = QuadrotorState()
      rotorcraft.hover(state, Vector3(0, 0, -20), 0, Environment.Calm)
      rotorcraft.step(state, Setpoint.hold(Vector3(0, 0, -20)), Environment.Calm)
    // Each consists of a model, a batch for measuring, and a batch for flying.
    val until = System.nanoTime + 60_000_000_000L
    while NativeMemory.freed < before + 9 && System.nanoTime < until do
      System.gc()
      Thread.sleep(100)
    assert(NativeMemory.freed >= before + 9, s"${NativeMemory.freed - before} are freed")

  flying("a body with too weak a moment is refused by its axis, and a slightly stronger one flies"):
    for (axis, weak) <- Seq("front" -> 1, "right" -> 2, "down" -> 3) do
      val refused =
        MujocoModel.read(write(crazyflie(Seq.tabulate(3)(i => if i + 1 == weak then 0.05 else 12))))
      assert(refused.left.exists(_.contains(s"turn it about its $axis axis by")), s"$axis: $refused")
    val published = MujocoModel.read(write(crazyflie(Seq(0.4175, 0.4175, 0.309))))
    assert(
      clue(published).left.exists(_.endsWith(
        "expected moments that turn it about its front axis by 7.8 rad/s² or more while it hovers, " +
          "got 0.42 rad/s²: 19 times as much is needed"
      ))
    )
    val rotorcraft = MujocoRotorcraft(read(write(crazyflie(Seq(8, 8, 1.1)))))
    val state      = QuadrotorState()
    rotorcraft.hover(state, Vector3(0, 0, -5), 0, Environment.Calm)
    var lowest = -5.0
    for turn <- 0 until 4; _ <- 0 until (5 / rotorcraft.stepS).toInt do
      rotorcraft.step(
        state,
        Setpoint.velocityZ(3 * math.cos(turn * 2), 3 * math.sin(turn * 2), -5),
        Environment.Calm
      )
      lowest = lowest.max(state.z)
    assert(lowest < -3.5, s"came down to $lowest m")

  flying("a model that cannot fly is refused with the reason"):
    assert(MujocoModel.read(Path.of("nowhere.xml")).left.exists(_.contains("there is no nowhere.xml")))
    val last = "<general site=\"rear right\" gear=\"0 0 4.179 0 0 0.0556\"/>"
    for (from, to, reason) <- Seq(
        ("<mujoco model", "<mjcf model", "XML parse error"),
        (
          "<freejoint/>",
          "<joint type=\"hinge\"/>",
          "expected the vehicle's free joint to be the first joint"
        ),
        (last, "", "expected at least 4 actuators, got 3"),
        ("mass=\"1\"", "mass=\"2\"", "by which it hovers, got 0.0 to 1.0"),
        ("0.0556", "0", "none yaws it"),
        ("site=\"rear right\"", "site=\"front left\"", "each by itself"),
        ("ctrlrange=\"0 1\"", "ctrlrange=\"-1 0\"", "expected a control range above 0.0"),
        ("dyntype=\"filterexact\"", "dyntype=\"muscle\" gaintype=\"muscle\"", "")
      )
    do
      val refused = MujocoModel.read(write(text("quadrotor").replace(from, to)))
      assert(refused.left.exists(_.contains(reason)), s"$from as $to: $refused")

private object MujocoRotorcraftLiveSuite:
  private val root =
    Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at =>
      Files.exists(at.resolve("ARCHITECTURE.md"))
    ).get

  def path(name: String): Path = root.resolve(s"examples/mujoco/$name.xml")

  def text(name: String): String = Files.readString(path(name))

  private val examples = TrieMap.empty[String, MujocoModel]

  def example(name: String): MujocoModel = examples.getOrElseUpdate(name, read(path(name)))

  def changed(from: String, to: String): MujocoModel = read(write(text("quadrotor").replace(from, to)))

  def write(xml: String): Path =
    val file = Files.createTempFile("model", ".xml")
    file.toFile.deleteOnExit()
    Files.writeString(file, xml)

  /** Crazyflie 2's model, with these greatest angular accelerations about front, right and down, rad/s². */
  def crazyflie(turning: Seq[Double]): String =
    val moments = turning.zip(Seq(2.3951e-5, 2.3951e-5, 3.2347e-5)).map((rate, inertia) =>
      java.math.BigDecimal(rate * inertia).toPlainString
    )
    val motors = moments.zip(Seq("-1 0 0", "0 -1 0", "0 0 -1")).map((moment, axis) =>
      s"""<motor ctrlrange="-$moment $moment" gear="0 0 0 $axis" site="a"/>"""
    )
    s"""<mujoco><option timestep="0.002" integrator="RK4"/><compiler inertiafromgeom="false" autolimits="true"/>
       |<worldbody><body pos="0 0 0.1"><freejoint/>
       |<inertial pos="0 0 0" mass="0.027" diaginertia="2.3951e-5 2.3951e-5 3.2347e-5"/>
       |<geom type="box" size=".05 .05 .01"/><site name="a"/></body></worldbody>
       |<actuator><motor ctrlrange="0 0.6" gear="0 0 1 0 0 0" site="a"/>${motors.mkString}</actuator>
       |</mujoco>""".stripMargin

  def read(file: Path): MujocoModel = MujocoModel.read(file).fold(sys.error, identity)
