package skein.recognition

import java.nio.file.Path
import scala.util.Using
import skein.flight.VirtualFlights
import skein.loop.{LoopKind, FlightOutcome}
import skein.onnx.{OnnxFiles, OnnxFormat, OnnxGraph, OnnxPolicy}
import skein.onnx.OnnxGraph.*
import skein.policy.*
import skein.settings.{FlySettings, PolicyFile}
import skein.signal.{Kinematics, LatencyProfile, SplitMix64}
import skein.testing.Unhurried
import skein.units.*

/** Policies of ONNX files compared with onnxruntime's own evaluation, and those that only it can run. */
class OnnxPolicyRuntimeSuite extends munit.FunSuite, OnnxFiles, Unhurried:
  for name <- Seq("learned:64x64", "learned:32tanhx32tanh:clip") do
    folder.test(s"$name: onnxruntime's results equal those of Skein's network, within 2e-6"): folder =>
      val random = SplitMix64(seed)
      val family = PolicyFamily.parse(name).fold(fail(_), identity)
      val policy = family
        .policy(Vector.fill(family.space.dimension)((0.6 * random.nextDouble() - 0.3).toFloat.toDouble))
        .asInstanceOf[LearnedPolicy]
      val file = written(folder, OnnxPolicy.write(policy, "pursuer").fold(fail(_), identity))
      Using.resource(OnnxModel.load(Path.of(file)).fold(fail(_), identity)): model =>
        val differences = Vector.fill(500):
          val what   = seen(random, 0.2)
          val answer = model.run(what.fromOwnHeading.map(_.toFloat), Vector(1, 9)).fold(fail(_), identity)
          math.abs(answer("action").values.head - policy.shares(what.fromOwnHeading)(0))
        assert(differences.max < 2e-6, s"seed $seed: ${differences.max}")

  private val weights = Tensor(Vector(9, 1), Vector(0.0, 1, 0, 0, 0, 0, 0, 0, 0))

  private def model(operator: String): Array[Byte] = OnnxFormat.write(OnnxGraph(
    Vector(Node("MatMul", Vector("x", "w"), Vector("m")), Node(operator, Vector("m"), Vector("y"))),
    Map("w" -> weights),
    Vector(Port("x", Float32, Some(Vector(None, Some(9))))),
    Vector(Port("y", Float32, Some(Vector(None, Some(1)))))
  ))

  private def flown(policy: PolicyFile) =
    val settings = FlySettings(
      List(LoopKind.Stream),
      List(LatencyProfile.vpn),
      Span.ofSeconds(2),
      Span.ofMillis(100),
      seed = 7,
      policies = List(policy)
    )
    VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)

  folder.test("a model of another kind is run by onnxruntime, and recognised by its bytes"): folder =>
    val file   = written(folder, model("Erf"))
    val policy = PolicyFile.read(file).fold(fail(_), identity)
    assert(policy.name.startsWith("onnx:"), policy.name)
    def still(eastM: Double) =
      val there = Kinematics(Vector3(0, eastM, -20), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
      Seen(there, Span.Zero, isPredicted = false)
    val now = Observation(
      self = 0,
      vehicles = Vector(still(0), still(0.4)),
      opponent = 1,
      headings = Vector(Radians(0), Radians(0)),
      elapsed = Span.ofMillis(100),
      decisions = 1,
      cruise = MetresPerSecond(10),
      startDown = Metres(-20)
    )
    val decides  = policy.policy
    val (act, _) = decides.choose(now, decides.start)
    assertEqualsDouble(act.headingRad(0), 0.1 * 0.42839235, 1e-7)
    val (one, other) =
      (flown(policy), flown(PolicyFile.parse(policy.role, policy.text).fold(fail(_), identity)))
    assertEquals(one.landed.outcome, FlightOutcome.Completed)
    assertEquals(one.recorder.digest, other.recorder.digest)
    written(folder, model("Sin")): Unit
    assert(PolicyFile.parse(policy.role, policy.text).left.exists(_.contains("got another")))

  folder.test("a model that returns NaN ends the flight with that reason, and vehicles hover"): folder =>
    // The trial before the flight has a result, with the evader straight ahead; later observations have none.
    val policy = PolicyFile.read(written(folder, model("Acos"))).fold(fail(_), identity)
    val landed = flown(policy)
    landed.landed.outcome match
      case FlightOutcome.Failed(reason) =>
        assert(reason.contains("the policy: expected a number from -1 to 1, got NaN"), reason)
      case other => fail(s"$other")
    assert(landed.recorder.recording.commands.groupBy(_.vehicle).values.forall(_.nonEmpty))
