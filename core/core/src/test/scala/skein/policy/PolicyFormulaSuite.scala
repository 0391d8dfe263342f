package skein.policy

import skein.formula.{Evaluation, Untraceable}
import skein.signal.{Kinematics, SplitMix64}
import skein.units.*

/** A formula from the bytecode of a policy's method decides like the method, over several decisions with
  * memory. Methods that are not formulas are refused with their source line.
  */
class PolicyFormulaSuite extends munit.FunSuite:
  import PolicyFormulaSuite.*

  private val count      = 4
  private val assignment = Assignment(Vector(Vector(1, 2, 3), Vector(0), Vector(0), Vector(0)))
  private val seed       = 7L

  private def formulaOf(policy: Policy, self: Int): Either[Untraceable, PolicyFormula] =
    PolicyFormula.of(policy, self, assignment, isPredicted = false)

  private def drawn(random: SplitMix64, self: Int): Observation =
    def within(most: Double) = most * (2 * random.nextDouble() - 1)
    val seen                 = Vector.fill(count):
      Seen(
        Kinematics(
          Vector3(within(30), within(30), -20 + within(1)),
          Vector3(within(8), within(8), within(1)),
          Quaternion.Identity,
          Vector3.Zero
        ),
        Span.ofSeconds(random.nextDouble()),
        isPredicted = false
      )
    val opponent = assignment.opponentOf(
      self,
      other => seen(self).kinematics.positionNed.horizontalDistance(seen(other).kinematics.positionNed)
    )
    Observation(
      self,
      seen,
      opponent,
      Vector.fill(count)(Radians(within(6))),
      Span.ofSeconds(random.nextDouble()),
      3,
      MetresPerSecond(5 + within(3)),
      Metres(-20),
      Map.empty,
      Span.ofSeconds(random.nextDouble())
    )

  private def answered(of: PolicyFormula, policy: Policy, seen: Observation, memory: Array[Double]) =
    val inputs = of.inputs.map:
      case PolicyInput.Position(vehicle, axis) =>
        val place = seen.vehicles(vehicle).kinematics.positionNed
        Vector(place.x, place.y, place.z)(axis)
      case PolicyInput.Velocity(vehicle, axis) =>
        val velocity = seen.vehicles(vehicle).kinematics.velocityNed
        Vector(velocity.x, velocity.y, velocity.z)(axis)
      case PolicyInput.Heading(vehicle) => seen.headings(vehicle).value
      case PolicyInput.Age(vehicle)     => seen.vehicles(vehicle).age.toSeconds
      case PolicyInput.Elapsed          => seen.elapsed.toSeconds
      case PolicyInput.ActsIn           => seen.actsIn.toSeconds
      case PolicyInput.Time             => seen.time.toSeconds
      case PolicyInput.Cruise           => seen.cruise.value
      case PolicyInput.StartDown        => seen.startDown.value
      case PolicyInput.Memory(number)   => memory(number)
    val nodes =
      (of.motion match
        case PolicyFormula.Motion.Along(heading, speed) => Vector(heading, speed)
        case PolicyFormula.Motion.With(north, east)     => Vector(north, east)
      ) ++ of.memory
    Evaluation(nodes)(inputs.toArray, of.parametersOf(policy)).toVector

  private val own: Seq[(String, SplitMix64 => Policy)] = Seq(
    "the chase of the README"                          -> (_ => Chase),
    "ages and lengths of time"                         -> (_ => Ages),
    "a memory that is a case class"                    -> (random => Weaving(random.nextDouble())),
    "a memory that is a vector of case classes"        -> (_ => Trails),
    "a memory that is a tuple with an option's choice" -> (_ => Pairs),
    "loops over the team"                              -> (_ => Crowd),
    "the nearest by minBy, maps, sums and indices"     -> (_ => Collections),
    "cases of an enumeration of its own, by data"      -> (_ => Modes),
    "yaw, and a choice between actions"                -> (_ => Looking),
    "the heading of another and the own"               -> (_ => Mirror),
    "a choice between a heading and a velocity"        -> (_ => Braking),
    "a policy against one opponent"                    -> (random => LeadPursuit(random.nextDouble()))
  )

  private def ours: Seq[(String, SplitMix64 => Policy)] =
    def within(random: SplitMix64, least: Double, most: Double) = least + (most - least) * random.nextDouble()
    def circuit(random: SplitMix64) = Racetrack(within(random, 0, 60), within(random, 5, 30))
    def pursuit(random: SplitMix64) = Pursuit(random.nextDouble(), random.nextDouble())
    Seq(
      "flee"        -> (random => Flee(within(random, 1, 6))),
      "surrounding" -> (random =>
        Surrounding(1, within(random, 4, 16), within(random, 4, 12), pursuit(random))
      ),
      "lead on circuit" -> (random =>
        LeadOnCircuit(circuit(random), within(random, 2, 8), within(random, 1, 9))
      ),
      "follow on circuit" -> (random => FollowOnCircuit(1, circuit(random), within(random, 2, 8), 9, 3)),
      "keep slot"         -> (random =>
        KeepSlot(1, circuit(random), -within(random, 1, 9), within(random, -9, 9), 10, random.nextDouble())
      ),
      "avoidance" -> (random =>
        Avoidance(within(random, -30, 30), within(random, -30, 30), 5, 8, 2, within(random, 0.5, 2), 4)
      )
    )

  for (name, draw) <- own ++ ours; self <- Seq(0, 2) do
    test(s"$name, as vehicle $self: the formula decides like the method (seed $seed)"):
      val random  = SplitMix64(seed)
      val formula = formulaOf(draw(random), self).fold(throw _, identity)
      for _ <- 1 to 6 do
        val policy = draw(random)
        assert(formula.fits(policy, assignment), s"$policy")
        var held    = policy.start
        var numbers = formula.startOf(policy)
        for step <- 1 to 25 do
          val seen           = drawn(random, self)
          val (action, next) = policy.choose(seen, held.asInstanceOf[policy.Memory])
          val came           = answered(formula, policy, seen, numbers)
          val expected       = action match
            case flown: (Action.VelocityAt | Action.Along) =>
              val Action.VelocityAt(north, east, down, _) = flown.byVelocity: @unchecked
              assertEquals(down, seen.startDown)
              (north, east)
            case other => fail(s"$other")
          val actual = formula.motion match
            case PolicyFormula.Motion.With(_, _)  => (came(0), came(1))
            case PolicyFormula.Motion.Along(_, _) =>
              (came(1) * StrictMath.cos(came(0)), came(1) * StrictMath.sin(came(0)))
          assertEqualsDouble(actual._1, expected._1, 1e-9, s"north, step $step")
          assertEqualsDouble(actual._2, expected._2, 1e-9, s"east, step $step")
          held = next
          numbers = came.drop(2).toArray
      assertEquals(formula.leaves(draw(random), Metres(-20)), None)

  test(
    "hovering, 3D velocities and commanded altitudes have a vertical formula, and leave the starting altitude"
  ):
    for (policy, third, holds) <-
        Seq((Hovering, 0.0, 0.0), (Rising, -1.5, 0.0), (Higher(Metres(-30)), -30.0, 1.0))
    do
      val formula = formulaOf(policy, 0).fold(throw _, identity)
      assertEquals(formula.leaves(policy, Metres(-20)), Some("it leaves the altitude of its vehicle's start"))
      val vertical = formula.vertical.getOrElse(fail(s"$policy: it has no vertical part"))
      val numbers  = Evaluation(Vector(vertical.third, vertical.holds))(
        Array.ofDim[Double](formula.inputs.size),
        formula.parametersOf(policy)
      )
      assertEquals(numbers.toSeq, Seq(third, holds), s"$policy")

  for
    (name, policy, reason) <- Seq(
      ("a place", Going, "it decides for Action.Position"),
      ("one of two actions", Sometimes, "it decides for Action.Land"),
      ("the attitude", Tilted, "it reads the attitude"),
      ("counted decisions", Counting, "it counts its decisions"),
      ("a loop without end", Endless, "a loop whose end depends on what is observed"),
      ("a rounded number", Rounded, "round is not among the functions"),
      ("a product of lengths of time", Products, "it computes with a length of time"),
      ("what it remembers changes its form", Growing, "what it remembers is of another form")
    )
  do
    test(s"$name is refused, with its source line"):
      val refused = formulaOf(policy, 0).fold(identity, _ => fail("it was traced"))
      assert(clue(refused.getMessage).contains(reason))
      assert(clue(refused.where).contains("PolicyFormulaSuite.scala:"))

  test("a policy is refused if its memory contains a long, or if it reads sensors"):
    assert(clue(formulaOf(Longs, 0).left.map(_.getMessage)).left.exists(_.contains("is a long")))
    assert(clue(formulaOf(Sensing, 0).left.map(_.getMessage)).left.exists(_.contains("sensors")))

  test("a policy that leaves the altitude of its start is reported; one that commands that altitude is not"):
    val higher = formulaOf(Higher(Metres(-25)), 0).fold(throw _, identity)
    assert(clue(higher.leaves(Higher(Metres(-25)), Metres(-20))).nonEmpty)
    assertEquals(higher.leaves(Higher(Metres(-20)), Metres(-20)), None)
    assert(formulaOf(Climbing, 0).fold(throw _, identity).leaves(Climbing, Metres(-20)).nonEmpty)

  test("a formula states whether its policy may turn the vehicle"):
    assert(formulaOf(Looking, 0).fold(throw _, identity).turns)
    assert(!formulaOf(Chase, 0).fold(throw _, identity).turns)

object PolicyFormulaSuite:
  private def towards(seen: Observation, vehicle: Int) =
    seen.vehicles(vehicle).kinematics.positionNed - seen.own.kinematics.positionNed

  private def flying(seen: Observation, north: Double, east: Double) =
    Action.VelocityAt(north, east, seen.startDown)

  case object Chase extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val way = seen.vehicles(seen.opponent).kinematics.positionNed - seen.own.kinematics.positionNed
      (Action.Along(Radians(StrictMath.atan2(way.y, way.x)), seen.cruise, seen.startDown), ())

  case object Ages extends Policy.Memoryless:
    private val old                       = Span.ofMillis(400)
    def action(seen: Observation): Action =
      val other = seen.vehicles(seen.opponent)
      val spent = seen.own.age.max(other.age) + seen.elapsed - Span.ofMillis(100)
      val late  = if spent > old then old else spent
      val ahead = other.kinematics.positionNed + other.kinematics.velocityNed * late.toSeconds
      val speed = if other.age <= seen.own.age then 3 + seen.actsIn.toMillis / 1000 else 5.0
      val way   = ahead - seen.own.kinematics.positionNed
      Action.Along(Radians(StrictMath.atan2(way.y, way.x)), MetresPerSecond(speed), seen.startDown)

  final case class Phase(angle: Double, isLeft: Boolean, rounds: Int)
  final case class Weaving(rate: Double) extends Policy:
    type Memory = Phase
    def start: Phase                                              = Phase(0.25, true, 0)
    def choose(seen: Observation, memory: Phase): (Action, Phase) =
      val angle = memory.angle + rate * seen.elapsed.toSeconds * (if memory.isLeft then 1 else -1)
      val next  =
        if angle.abs > 0.5 then Phase(angle.min(0.5).max(-0.5), !memory.isLeft, memory.rounds + 1)
        else memory.copy(angle = angle)
      val way = towards(seen, seen.opponent)
      val by  = if next.rounds > 2 then 0.5 else 1.0
      (
        Action.Along(Radians(StrictMath.atan2(way.y, way.x) + angle * by), seen.cruise, seen.startDown),
        next
      )

  final case class Place(north: Double, east: Double)
  case object Trails extends Policy:
    type Memory = Vector[Place]
    def start: Vector[Place] = Vector.fill(3)(Place(1, 2))
    def choose(seen: Observation, memory: Vector[Place]): (Action, Vector[Place]) =
      val here   = seen.own.kinematics.positionNed
      val next   = memory.tail :+ Place(here.x, here.y)
      val middle = next.map(_.north).sum / next.size
      val bent   = next.updated(0, Place(memory.head.north * 0.5, next(0).east))
      (flying(seen, middle / 10, next.foldLeft(0.0)((sum, each) => sum + each.east) / 30), bent)

  case object Pairs extends Policy:
    type Memory = (Double, Double)
    def start: (Double, Double)                                                         = (0.0, 1.0)
    def choose(seen: Observation, memory: (Double, Double)): (Action, (Double, Double)) =
      val (north, east) = memory
      val way           = towards(seen, seen.opponent)
      val near          = Option.when(way.norm < 25)(way)
      val next          = near.fold((north * 0.5, 1.0))(place => (place.x / 10, east + 0.1))
      (flying(seen, next._1, next._2.min(4)), next)

  case object Crowd extends Policy.Memoryless:
    def action(seen: Observation): Action =
      var (north, east) = (0.0, 0.0)
      for vehicle <- seen.vehicles.indices if vehicle != seen.self do
        val way = towards(seen, vehicle)
        if way.norm < 30 then
          north -= way.x / 10
          east -= way.y / 10
      for (each, i) <- seen.vehicles.zipWithIndex do north += each.kinematics.velocityNed.x * 0.01 * i
      flying(seen, north, east)

  case object Collections extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val others  = seen.vehicles.indices.filter(_ != seen.self)
      val nearest = others.minBy(towards(seen, _).norm)
      val way     = towards(seen, nearest)
      val oldest  = seen.vehicles.map(_.age.toSeconds).max
      val mean    = others.map(i => seen.vehicles(i).kinematics.velocityNed.y).sum / others.size
      flying(seen, way.x / 10 + oldest, way.y / 10 + mean + nearest * 0.1)

  enum Mode:
    case Wait
    case Go(speed: Double)
    case Flee(by: Vector3)
  case object Modes extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val way  = towards(seen, seen.opponent)
      val mode =
        if way.norm > 40 then Mode.Go(way.norm / 10) else if way.norm > 10 then Mode.Wait else Mode.Flee(way)
      mode match
        case Mode.Wait      => flying(seen, 0, 0)
        case Mode.Go(speed) => flying(seen, speed, -speed)
        case Mode.Flee(by)  => flying(seen, -by.x, -by.y)

  case object Looking extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val way = towards(seen, seen.opponent)
      if way.x > 0 then Action.VelocityAt(way.x / 9, 1, seen.startDown, Yaw.Forward)
      else Action.VelocityAt(2, way.y / 9, seen.startDown, Yaw.Towards(Radians(way.y)))

  case object Mirror extends Policy.Memoryless:
    def action(seen: Observation): Action =
      val between = (seen.headings(seen.opponent).value + seen.headings(seen.self).value) / 2
      Action.Along(Radians(between), MetresPerSecond(seen.headings.size), seen.startDown)

  case object Braking extends Policy:
    type Memory = Double
    def start: Double                                               = 0.5
    def choose(seen: Observation, memory: Double): (Action, Double) =
      val way    = towards(seen, seen.opponent)
      val turned = seen.headingRad + memory * seen.elapsed.toSeconds
      val action =
        if way.norm > 30 then seen.along(turned, seen.cruise.value)
        else if way.norm > 20 then flying(seen, 0, 0)
        else flying(seen, way.x / 5, way.y / 5)
      (action, memory * 0.9)

  case object Hovering extends Policy.Memoryless:
    def action(seen: Observation): Action = Action.Hover
  case object Rising extends Policy.Memoryless:
    def action(seen: Observation): Action = Action.Velocity(Vector3(1, 2, -1.5))
  case object Going extends Policy.Memoryless:
    def action(seen: Observation): Action = Action.Position(Vector3(1, 2, -20), seen.cruise)
  case object Sometimes extends Policy.Memoryless:
    def action(seen: Observation): Action =
      if seen.own.kinematics.positionNed.x > 0 then flying(seen, 1, 2) else Action.Land
  case object Tilted extends Policy.Memoryless:
    def action(seen: Observation): Action = flying(seen, seen.own.kinematics.orientation.yawRad, 0)
  case object Counting extends Policy.Memoryless:
    def action(seen: Observation): Action = flying(seen, seen.decisions.toDouble, 0)
  case object Endless extends Policy.Memoryless:
    def action(seen: Observation): Action =
      var north = seen.own.kinematics.positionNed.x
      while north > 1 do north /= 2
      flying(seen, north, 0)
  case object Rounded extends Policy.Memoryless:
    def action(seen: Observation): Action =
      flying(seen, math.round(seen.own.kinematics.positionNed.x).toDouble, 0)
  case object Products extends Policy.Memoryless:
    def action(seen: Observation): Action = flying(seen, (seen.elapsed / 3).toSeconds, 0)
  case object Growing extends Policy:
    type Memory = Vector[Double]
    def start: Vector[Double]                                                       = Vector(1.0)
    def choose(seen: Observation, memory: Vector[Double]): (Action, Vector[Double]) =
      (flying(seen, memory.sum, 0), memory :+ 2.0)
  case object Longs extends Policy:
    type Memory = Long
    def start: Long                                             = 0
    def choose(seen: Observation, memory: Long): (Action, Long) = (flying(seen, 1, 0), memory + 1)
  case object Sensing extends Policy.Memoryless:
    override def sensors: Set[String]     = Set("lidar")
    def action(seen: Observation): Action = flying(seen, 1, 0)
  final case class Higher(down: Metres) extends Policy.Memoryless:
    def action(seen: Observation): Action = Action.VelocityAt(1, 2, down)
  case object Climbing extends Policy.Memoryless:
    def action(seen: Observation): Action =
      Action.VelocityAt(1, 2, Metres(seen.own.kinematics.positionNed.z - 1))
