package skein.cli

import java.nio.file.Files
import skein.testing.TemporaryFolders

/** `./skein observe --ros`, up to the point that needs ROS 2; `ObservedGraphLiveSuite` tests the rest. */
class ObserveRosSuite extends munit.FunSuite, TemporaryFolders:
  test("without ROS 2, a line states what is missing, and no program is started"):
    assume(!Seq("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH").exists(sys.env.contains), "ROS 2 may be here")
    val mark = temporaryFolder().resolve("started")
    val ran  = Ran.of(ObserveCommand.run(Seq("--ros", "--", "touch", mark.toString)))
    assertEquals(ran.status, 1)
    assertEquals(ran.err.linesIterator.size, 1, ran.err)
    assert(ran.err.contains("--ros: ROS 2 was not found: expected librcl.so in lib of a folder of"), ran.err)
    assert(!Files.exists(mark))
