package skein.cluster

import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import java.util.concurrent.{CompletableFuture, TimeUnit}
import java.util.concurrent.atomic.AtomicInteger
import scala.jdk.CollectionConverters.*
import skein.testing.TemporaryFolders

class WorkerProcessesSuite extends munit.FunSuite, TemporaryFolders:

  test("workers have their own class archive, shared with manually started ones"):
    val option = "-XX:SharedArchiveFile=/opt/skein/skein-vector.jsa"
    val own    = WorkerProcesses.ofWorkers(option)
    assertEquals(own, "-XX:SharedArchiveFile=/opt/skein/skein-vector-worker.jsa")
    assertEquals(WorkerProcesses.ofWorkers(own), own)
    assertEquals(WorkerProcesses.ofWorkers("-Xmx1g"), "-Xmx1g")

  test("a worker runs with this program's JVM, options and class path"):
    val command = WorkerProcesses.likeThis("skein.cli.main", Seq("worker", "--join", "lab:2552"))
    assertEquals(command.head, Path.of(sys.props("java.home"), "bin", "java").toString)
    assertEquals(
      command.takeRight(6),
      Seq("-cp", sys.props("java.class.path"), "skein.cli.main", "worker", "--join", "lab:2552")
    )
    val options = ManagementFactory.getRuntimeMXBean.getInputArguments.asScala.toSeq
    assertEquals(
      command.drop(1).dropRight(6),
      options.filterNot(option => option.startsWith("-agentlib") || option.startsWith("-Xrun"))
        .map(WorkerProcesses.ofWorkers)
    )

  test("a truncated class archive is removed before a worker starts"):
    val archive                        = temporaryFolder().resolve("skein-worker.jsa")
    def isKeptWith(bytes: Array[Byte]) =
      Files.write(archive, bytes)
      WorkerProcesses.starting(Seq("java", s"-XX:SharedArchiveFile=$archive", "worker")): Unit
      Files.exists(archive)
    assert(isKeptWith(Array[Byte](0xa8.toByte, 0x0b, 0xf0.toByte, 0x0f)))
    assert(!isKeptWith(Array[Byte](0, 0, 0, 0, 1)))
    assert(!isKeptWith(Array.emptyByteArray))
    // Without an archive nothing is missing.
    WorkerProcesses.starting(Seq("java", s"-XX:SharedArchiveFile=$archive", "worker")): Unit

  test("killed workers are replaced while they compute; workers that never compute are given up"):
    val folder    = temporaryFolder()
    val ended     = AtomicInteger()
    val givenUp   = CompletableFuture[String]()
    val processes = WorkerProcesses(
      1,
      Seq("false"),
      number => folder.resolve(s"$number.log"),
      _ => ended.incrementAndGet() <= 9,
      givenUp.complete(_): Unit
    )
    processes.start()
    assert(clue(givenUp.get(
      60,
      TimeUnit.SECONDS
    )).contains("end before they have computed anything, with status 1"))
    // The tenth and three more.
    assertEquals(ended.get, 13)
    processes.close()

  test("a worker ends once its parent's pipe has closed, whatever bytes arrive before"):
    val before = System.in
    val pipe   = java.io.ByteArrayInputStream(Array[Byte](0, 1, -1, 0))
    val left   = CompletableFuture[Int]()
    System.setIn(pipe)
    try
      WorkerProcesses.endWithParent(() => left.complete(pipe.available): Unit)
      assertEquals(left.get(60, TimeUnit.SECONDS).toInt, 0)
    finally System.setIn(before)
