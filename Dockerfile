# Skein with its JDK: docker build -t skein . && docker run --rm -v "$PWD/flights:/skein/flights" skein fly --clock virtual
FROM eclipse-temurin:25-jdk
RUN apt-get update && apt-get install -y --no-install-recommends maven python3 && rm -rf /var/lib/apt/lists/*
WORKDIR /skein
COPY . .
RUN ./skein --help
ENTRYPOINT ["./skein"]
