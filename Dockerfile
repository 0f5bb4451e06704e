# docker build -t fracparticles . && docker run -v "$PWD/results:/study/results" fracparticles
FROM python:3.11-slim
RUN apt-get update && apt-get install --yes --no-install-recommends make && rm -rf /var/lib/apt/lists/*
WORKDIR /study
COPY requirements.lock pyproject.toml Makefile ./
RUN sed -n '/^# The following packages/,$p' requirements.lock > first.lock \
    && pip install --no-cache-dir --require-hashes -r first.lock \
    && pip install --no-cache-dir --require-hashes --no-build-isolation --use-pep517 -r requirements.lock
COPY . .
RUN pip install --no-cache-dir --no-deps --no-build-isolation -e .
CMD ["snakemake", "-j2"]
