package skein.simulator

import java.nio.file.{Files, Path}
import scala.io.Source
import upack.*

/** Everything that AirSim's published Python client calls is answered and documented. `list_methods.py`
  * writes `methods.txt` from the client itself; [[OfficialPythonClientLiveSuite]] checks that.
  */
class PublishedClientSuite extends munit.FunSuite:

  private val called: Map[String, Int] =
    val source = Source.fromResource("airsim-python/methods.txt")
    try source.getLines().map(_.split(' ')).map(words => words(0) -> words(1).toInt).toMap
    finally source.close()

  private val page =
    val root = Iterator
      .iterate(Path.of("").toAbsolutePath)(_.getParent)
      .find(path => Files.exists(path.resolve("build.sbt")))
      .get
    Files.readString(root.resolve("docs/airsim-methods.md"))

  private val row                         = """(?m)^\| `(\w+)` \| (\w+) \|""".r
  private val told: Seq[(String, String)] =
    row.findAllMatchIn(page).map(found => found.group(1) -> found.group(2)).toSeq

  test("every function of the published client exists, with as many arguments as it sends"):
    assertEquals(called.size, 125)
    val here = Simulation.methods.map(method => method.name -> method.arity).toMap
    for (name, arity) <- called do assertEquals(here.get(name), Some(arity), name)

  test("no function exists twice"):
    assertEquals(Simulation.methods.map(_.name).distinct.size, Simulation.methods.size)

  test("the page lists every existing function once, and only existing functions"):
    assertEquals(told.map(_._1).sorted, Simulation.methodNames.toSeq.sorted)
    assertEquals(told.map(_._2).toSet, Set("true", "kept", "checked", "refused"))

  test("exactly the functions that the page calls refused are refused"):
    for (name, how) <- told do
      val answer  = SampleCalls.answered(name)
      val refused = answer match
        case Left(_)                          => true
        case Right(Bool(false))               => how == "refused"
        case Right(Arr(none)) if none.isEmpty => how == "refused"
        case Right(_)                         => false
      assertEquals(refused, how == "refused", s"$name is said to be $how and answered $answer")
