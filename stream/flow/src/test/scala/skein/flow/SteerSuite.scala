package skein.flow

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.duration.*
import scala.concurrent.{ExecutionContext, Future, Promise}
import scala.util.{Success, Try}
import skein.units.*
import skein.vtime.VirtualTime

class SteerSuite extends munit.FunSuite:
  import Steered.*

  /** A vehicle behind a link: a command arrives after `oneWay` and ends the one before, whose answer takes as
    * long.
    */
  private final class FarVehicle(oneWay: FiniteDuration)(using system: ActorSystem):
    private given ExecutionContext              = system.dispatcher
    private var flying: Option[Promise[String]] = None
    private var outstanding                     = 0
    var mostOutstanding                         = 0

    def send(command: Int): Future[String] =
      outstanding += 1
      mostOutstanding = mostOutstanding.max(outstanding)
      val ended = Promise[String]()
      val _     = after(oneWay)(Future.successful(replaceWith(Some(ended))))
      ended.future
        .flatMap(result => after(oneWay)(Future.successful(s"$command $result")))
        .andThen(_ => outstanding -= 1)

    def hover(): Future[String] =
      after(oneWay)(Future.successful(replaceWith(None))).flatMap(_ =>
        after(oneWay)(Future.successful("hovering"))
      )

    private def replaceWith(next: Option[Promise[String]]): Unit =
      flying.foreach(_.success("superseded"))
      flying = next

  /** Results of ten commands over a link: events in order, with their times in ms from the start; the
    * greatest number of outstanding calls; and the commands that were replaced before they were sent.
    */
  private def steered(oneWay: FiniteDuration, every: FiniteDuration, minInterval: Span) =
    var replaced = Vector.empty[Int]
    val run      = VirtualTime.run(seed = 1): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val start              = clock.now()
      val vehicle            = FarVehicle(oneWay)
      Source
        .tick(0.millis, every, ())
        .zipWithIndex
        .map(_._2.toInt)
        .take(10)
        .via(Newest(replaced :+= _))
        .via(Steer(minInterval, clock)(vehicle.send, () => vehicle.hover(), _ => true, _ => ()))
        .map(event => (clock.now().since(start).toNanos / 1_000_000, event))
        .runWith(Sink.seq)
        .map((_, vehicle.mostOutstanding))
    (run.value._1, run.value._2, replaced)

  private def endsOnce(events: Seq[(Long, Steered[Int, String])], replaced: Seq[Int]): Unit =
    val ended = events.collect { case (_, Ended(command, _, _)) => command }
    assertEquals((ended ++ replaced).sorted, (0 until 10).toSeq)

  test("over a fast link every command is sent immediately, and ends when the next one arrives"):
    val (events, most, replaced) = steered(oneWay = 18.millis, every = 100.millis, minInterval = Span.Zero)
    assertEquals(
      events.collect { case (at, Sent(command, _)) => (at, command) },
      (0 until 10).map(n => (n * 100L, n))
    )
    assertEquals(
      events.collect { case (at, Ended(command, _, Success(_))) => (at, command) }.take(2),
      Seq(136L -> 0, 236L -> 1)
    )
    assertEquals(most, 2)
    endsOnce(events, replaced)

  test("over a slow link at most two commands are outstanding, and the newest waiting command wins"):
    val (events, most, replaced) = steered(oneWay = 190.millis, every = 100.millis, minInterval = Span.Zero)
    assertEquals(most, 2)
    assertEquals(
      events.collect { case (at, Sent(command, _)) => (at, command) },
      Seq(0L -> 0, 100L -> 1, 480L -> 4, 861L -> 8, 1241L -> 9)
    )
    assertEquals(replaced, Vector(2, 3, 5, 6, 7))
    endsOnce(events, replaced)

  test("the rate cap delays a burst, and its newest command is sent"):
    val (events, _, replaced) = steered(oneWay = 1.milli, every = 10.millis, minInterval = Span.ofMillis(55))
    assertEquals(
      events.collect { case (at, Sent(command, _)) => (at, command) },
      Seq(0L -> 0, 55L -> 5, 110L -> 9)
    )
    endsOnce(events, replaced)

  test("at the end the vehicle is parked, so that the last move is answered, too"):
    val (events, _, _) = steered(oneWay = 18.millis, every = 100.millis, minInterval = Span.Zero)
    val last           = events.collect { case (at, Ended(9, _, result)) => (at, result) }
    assertEquals(last, Seq(972L -> Success("9 superseded")))

  test("a move answered after parking is reported before the end"):
    val run = VirtualTime.run(seed = 1): system =>
      given ActorSystem                                = system
      val clock                                        = Clock.ofNanos(VirtualTime.clock(system))
      def answered(in: FiniteDuration, answer: String) = after(in)(Future.successful(answer))
      Source
        .single(1)
        .via(Steer(
          Span.Zero,
          clock
        )((_: Int) => answered(100.millis, "superseded"), () => answered(10.millis, "hovers")))
        .runWith(Sink.seq)
    assertEquals(
      run.value.collect { case Ended(command, _, how) => (command, how) },
      Seq((1, Success("superseded")))
    )

  test("without a command in progress, the next is pulled when the last has ended"):
    val sent = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        val clock         = Clock.ofNanos(VirtualTime.clock(system))
        val start         = clock.now()
        def call()        = after(10.millis)(Future.successful("done"))
        Source
          .repeat(1)
          .take(3)
          .via(Steer(Span.Zero, clock, mostOutstanding = 1)((_: Int) => call(), () => call()))
          .collect { case Sent(_, at) => at.since(start).toNanos / 1000 }
          .runWith(Sink.seq)
      .value
    assertEquals(sent, Seq(0L, 10_000L, 20_000L))

  test("no commands are pulled while as many events as allowed wait for downstream"):
    val sent = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        var commands           = 0
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        def send()             =
          commands += 1
          Future.successful("done")
        val _ = Source
          .repeat(1)
          .via(Steer(Span.Zero, clock, mostOutstanding = 1)(
            (_: Int) => send(),
            () => Future.successful("hovering")
          ))
          // Takes the events of the first command, and no more.
          .mapAsync(2)(_ => Future.never)
          .runWith(Sink.ignore)
        after(1.second)(Future(commands))
      .value
    // Each command has two events: sent, and ended.
    assertEquals(sent, 1 + Steer.EventLimit / 2)

  test("after the last command has ended, the next is sent on arrival"):
    val sent = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem        = system
        val clock                = Clock.ofNanos(VirtualTime.clock(system))
        val start                = clock.now()
        def call(answer: String) = after(10.millis)(Future.successful(answer))
        Source
          .tick(0.millis, 10_200.micros, ())
          .zipWithIndex
          .map(_._2.toInt)
          .take(4)
          .via(Steer(Span.Zero, clock)(_ => call("done"), () => call("hovering"), _ => true, (_: Int) => ()))
          .collect { case Sent(command, at) => (command, at.since(start).toNanos / 1000) }
          .runWith(Sink.seq)
      .value
    assertEquals(sent, Seq(0 -> 0L, 1 -> 10_200L, 2 -> 20_400L, 3 -> 30_600L))

  /** Commands received by a vehicle whose first move's answer is lost after 150 ms, and whose hovers fail
    * `failures` times.
    */
  private def afterLoss(
      failures: Int,
      every: FiniteDuration = 200.millis,
      parksInDoubt: Boolean = true
  ): Vector[(Long, String)] =
    afterLossUs(failures, every, parksInDoubt).map((us, what) => (us / 1000, what))

  /** Commands received by such a vehicle, with times in µs. */
  private def afterLossUs(
      failures: Int,
      every: FiniteDuration,
      parksInDoubt: Boolean = true
  ): Vector[(Long, String)] =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem                        = system
        given ExecutionContext                   = system.dispatcher
        val clock                                = Clock.ofNanos(VirtualTime.clock(system))
        val start                                = clock.now()
        var heard                                = Vector.empty[(Long, String)]
        var flying: Option[Promise[Try[String]]] = None
        var hovers                               = 0
        def hear(what: String)                   = heard :+= (clock.now().since(start).toNanos / 1000, what)
        def send(command: Int)                   =
          hear(s"move $command")
          flying.foreach(_.trySuccess(Success("superseded")))
          val ended = Promise[Try[String]]()
          flying = Some(ended)
          if command == 0 then after(150.millis)(Future.successful("lost"))
          else ended.future.map(_.get)
        def hover() =
          hovers += 1
          hear("hover")
          if hovers <= failures then Future.successful("lost")
          else
            flying.foreach(_.trySuccess(Success("superseded")))
            flying = None
            after(10.millis)(Future.successful("hovering"))
        Source
          .tick(0.millis, every, ())
          .zipWithIndex
          .map(_._2.toInt)
          .takeWithin(700.millis)
          .via(Steer(Span.Zero, clock, parksInDoubt = parksInDoubt)(
            send,
            () => hover(),
            _ != "lost",
            command => hear(s"unsent $command")
          ))
          .runWith(Sink.ignore)
          .map(_ => heard)
      .value

  test("when an answer is lost the vehicle is parked before the next command"):
    assertEquals(
      afterLoss(failures = 0),
      Vector(
        0L   -> "move 0",
        150L -> "hover",
        200L -> "move 1",
        400L -> "move 2",
        600L -> "move 3",
        700L -> "hover"
      )
    )

  test("with numbered commands a lost answer parks nothing, but the last parking needs an answer"):
    assertEquals(
      afterLoss(failures = 2, parksInDoubt = false),
      Vector(
        0L   -> "move 0",
        200L -> "move 1",
        400L -> "move 2",
        600L -> "move 3",
        700L -> "hover",
        800L -> "hover",
        900L -> "hover"
      )
    )

  test("parking is repeated until it is answered, and the waiting command is sent then"):
    assertEquals(
      afterLoss(failures = 2).take(6),
      Vector(
        0L   -> "move 0",
        150L -> "hover",
        250L -> "hover",
        350L -> "hover",
        360L -> "move 1",
        400L -> "move 2"
      )
    )

  test("at the end parking is attempted ten times, and then given up"):
    val heard = afterLoss(failures = 99)
    assertEquals(heard.filter(_._1 >= 700).map(_._2), Vector.fill(10)("hover") :+ "unsent 1")

  test("while another move is outstanding, parking waits for it to begin"):
    assertEquals(
      afterLossUs(failures = 0, every = 100.millis).take(4),
      Vector(0L -> "move 0", 100_000L -> "move 1", 150_500L -> "hover", 200_000L -> "move 2")
    )

  test("a held vehicle is parked until it confirms, and no commands are sent"):
    val heard = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        val start              = clock.now()
        var heard              = Vector.empty[(Long, String)]
        var hovers             = 0
        def hear(what: String) = heard :+= (clock.now().since(start).toNanos / 1_000_000, what)
        val vehicle            = FarVehicle(10.millis)
        def park()             =
          hear("hover")
          hovers += 1
          if hovers == 1 then Future.successful("lost") else vehicle.hover()
        def send(command: Int) =
          hear(s"move $command")
          vehicle.send(command)
        val hold                        = Hold()
        def at(time: Int)(act: => Unit) = system.scheduler.scheduleOnce(time.millis)(act): Unit
        at(150)(hold.hold(): Unit)
        at(450)(hold.release(): Unit)
        Source
          .tick(0.millis, 100.millis, ())
          .zipWithIndex
          .map(_._2.toInt)
          .takeWithin(650.millis)
          .via(Steer(Span.Zero, clock)(send, park, _ != "lost", command => hear(s"unsent $command"), hold))
          .runWith(Sink.ignore)
          .map(_ => heard)
      .value
    assertEquals(
      heard,
      Vector(
        0L   -> "move 0",
        100L -> "move 1",
        150L -> "hover",
        200L -> "unsent 2",
        250L -> "hover",
        300L -> "unsent 3",
        400L -> "unsent 4",
        500L -> "move 5",
        600L -> "move 6",
        650L -> "hover"
      )
    )

  test("a vehicle that is held from the beginning is parked exactly once"):
    val parked = VirtualTime
      .run(seed = 1): system =>
        given ActorSystem      = system
        given ExecutionContext = system.dispatcher
        val clock              = Clock.ofNanos(VirtualTime.clock(system))
        var hovers             = 0
        def park()             =
          hovers += 1
          Future.successful("hovering")
        val hold = Hold()
        assert(hold.hold() && !hold.hold() && hold.isHeld)
        val commands = Source.maybe[Int]
        val _        = commands
          .via(Steer(Span.Zero, clock)((_: Int) => park(), () => park(), hold = hold))
          .runWith(Sink.ignore)
        after(1.second)(Future(hovers))
      .value
    assertEquals(parked, 1)
