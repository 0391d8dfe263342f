package skein.lanes

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.testing.{Lengthy, TemporaryFolders}

/** Runs all SIMD code in processes with vectors of 16, 32 and 64 bytes, as far as this machine supports them.
  */
class LaneDigestsLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:

  private def started(bytes: Int): (Process, Path, Path) =
    val (out, err) = (Files.createTempFile(folders, "out", ""), Files.createTempFile(folders, "err", ""))
    val java       = Path.of(sys.props("java.home"), "bin", "java").toString
    val options    =
      Seq(s"-XX:MaxVectorSize=$bytes", "--add-modules", "jdk.incubator.vector", "-XX:+UseSerialGC")
    val command =
      (java +: options) ++ Seq("-cp", sys.props("java.class.path"), "skein.lanes.printLaneDigests")
    (ProcessBuilder(command*).redirectOutput(out.toFile).redirectError(err.toFile).start(), out, err)

  private lazy val folders = temporaryFolder()

  test("searches, duels with separate delays, teams and plans have equal bits for 4, 8 and 16 lanes"):
    val told = Seq(16, 32, 64).map(started).map: (process, out, err) =>
      assertEquals(process.waitFor(), 0, Files.readString(err))
      Files.readAllLines(out).asScala.toVector
    val lanes = told.map(_.head).distinct
    assume(lanes.size > 1, s"this machine has ${lanes.mkString} alone")
    for other <- told.tail do assertEquals(other.tail.mkString("\n"), told.head.tail.mkString("\n"))
    for what <- Seq("duels shared", "duels own", "surround", "formation", "plan") do
      assert(told.head.exists(_.startsWith(what)), s"$what did not fly by lanes")
