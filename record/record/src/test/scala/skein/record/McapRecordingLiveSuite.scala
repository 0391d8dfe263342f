package skein.record

import java.nio.file.Files
import scala.jdk.CollectionConverters.*
import skein.mcap.{OfficialPythonLibrary, Told}
import skein.mcap.file.McapFile
import skein.testing.{TemporaryFolders, Unhurried}

/** Proof that other programs read exports: the official library of PyPI, unmodified. Runs if Python can
  * install it.
  */
class McapRecordingLiveSuite extends munit.FunSuite, TemporaryFolders, Unhurried:
  folder.test("the official library opens an export, and reads equal messages at equal times"): folder =>
    val recording = folder.resolve("flight.duckdb")
    val mcap      = folder.resolve("indexed.mcap")
    val recorder  = MemoryRecorder(Samples.heading)
    (1L to 1500).foreach: sequence =>
      recorder.offer(Samples.reading(sequence))
      recorder.offer(Samples.decision(sequence))
    Samples.oneOfEach.foreach(recorder.offer)
    assert(recorder.writeTo(recording).isRight)
    assertEquals(McapRecording.write(recording, mcap), Right(()))
    assertEquals(OfficialPythonLibrary.run("read.py", folder.toString), (0, "READ 1 files\n"))
    val ours  = McapFile.read(mcap)(_.map(_.fold(error => fail(error.message), identity)).toVector)
    val found = Files.readAllLines(folder.resolve("indexed.index.txt")).asScala.toVector
    assertEquals(found.filter(_.startsWith("message ")), ours.sortBy(_.message.logTime).map(Told.message))
    assert(found.size > 3000 + Samples.oneOfEach.size, s"${found.size}")
