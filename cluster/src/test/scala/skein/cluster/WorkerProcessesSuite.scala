package skein.cluster

class WorkerProcessesSuite extends munit.FunSuite:

  test("workers have an archive of classes of their own, and share it with those that are started by hand"):
    val option = "-XX:SharedArchiveFile=/opt/skein/skein-vector.jsa"
    val own    = WorkerProcesses.ofWorkers(option)
    assertEquals(own, "-XX:SharedArchiveFile=/opt/skein/skein-vector-worker.jsa")
    assertEquals(WorkerProcesses.ofWorkers(own), own)
    assertEquals(WorkerProcesses.ofWorkers("-Xmx1g"), "-Xmx1g")
